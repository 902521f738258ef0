// One implicit step a frame against as many explicit ones as are stable, on one lattice: simulated seconds a
// second. Explicit steps cost the same whatever moves; an implicit one costs more the more moves, so that its
// frames are those of a ball that is let go and swings.

#include "app/organ_setup.h"
#include "app/solver_choice.h"
#include "app/verify/implicit_bodies.h"
#include "bench/cases.h"
#include "gpu/gl.h"
#include "sim/implicit_solver.h"

#include <cmath>
#include <map>

namespace serosa::bench {

namespace {

constexpr int kAcross = 16; // cells of the ball
constexpr int kFrames = 6;  // a turn of implicit steps: from rest, by a tenth of a second
constexpr int kMostRounds = 3;
constexpr const char* kSolvers[] = {"cpu", "compute"};

struct Row {
    std::string name;
    std::unique_ptr<app::ImplicitBody> body;
    bool damped = false;
    int explicitSteps = 0;                                       // a frame
    sim::ImplicitEffort effort;                                  // sums over kFrames
    std::map<std::string, std::unique_ptr<sim::Solver>> solvers; // "cpu", "cpu implicit", ...
};

/// \param young Pa, of the whole ball; 0: the capsule of 1 MPa around 1 kPa
Row makeRow(const std::string& name, double young, double dampingTime) {
    Row row;
    row.name = name;
    row.body = app::capsuleBody(kAcross);
    row.damped = dampingTime > 0;
    sim::Tissue& tissue = row.body->setup.tissue;
    tissue.dampingTime = dampingTime;
    if (young > 0)
        tissue.young = tissue.others[0].young = young;
    tissue.others[0].dampingTime = dampingTime;
    return row;
}

std::vector<Row> makeRows() {
    std::vector<Row> rows;
    for (const double damping : {0.0, 0.0005})
        for (const auto& [name, young] :
             {std::pair{"1 kPa", 1e3}, {"20 kPa", 2e4}, {"1 MPa", 1e6}, {"1 kPa in a capsule of 1 MPa", 0.0}})
            rows.push_back(
                makeRow(name + (damping > 0 ? std::string(", damping time 0.5 ms") : ""), young, damping));
    return rows;
}

/// Compute passes take long where a processor runs them: damping is left to the other solver.
std::vector<std::string> solversOf(const Row& row) {
    return row.damped ? std::vector<std::string>{kSolvers[0]}
                      : std::vector<std::string>(std::begin(kSolvers), std::end(kSolvers));
}

Status addRow(Row& row, Rounds& rounds) {
    const sim::SolverSetup explicitSetup = row.body->withExplicitSteps(), &implicitSetup = row.body->setup;
    row.explicitSteps = int(std::lround(app::kImplicitFrame / explicitSetup.timeStep));
    for (const std::string& name : solversOf(row)) {
        SEROSA_ASSIGN(row.solvers[name], app::makeSolver(name, explicitSetup));
        rounds.add(name + row.name, [&row, &solver = *row.solvers[name]](int frames) {
            solver.advance(frames * row.explicitSteps);
            if (solver.textures())
                glFinish();
        });
        SEROSA_ASSIGN(row.solvers[name + " implicit"], app::makeSolver(name, implicitSetup));
        rounds.add(name + " implicit" + row.name,
                   [&row, &implicitSetup, &solver = *row.solvers[name + " implicit"]](int repeats) {
                       for (int i = 0; i < repeats; ++i) {
                           solver.setState(sim::startState(implicitSetup));
                           solver.advance(kFrames);
                           if (solver.textures())
                               glFinish();
                       }
                   });
    }
    sim::Solver& cpu = *row.solvers["cpu implicit"];
    cpu.setState(sim::startState(implicitSetup));
    for (int frame = 0; frame < kFrames; ++frame) {
        cpu.advance(1);
        const auto effort = sim::implicitEffort(cpu);
        row.effort.rounds += effort->rounds;
        row.effort.iterations += effort->iterations;
    }
    return {};
}

} // namespace

Status benchImplicit(const Options& options, Report& report) {
    std::vector<Row> rows = makeRows();
    Rounds rounds;
    for (Row& row : rows)
        SEROSA_TRY(addRow(row, rounds));
    rounds.measure(std::min(options.rounds, kMostRounds), options.seconds);

    report.heading("One implicit step a frame against explicit steps, ball of " +
                   app::grouped(rows.front().body->lattice.nodeCount()) +
                   " nodes, spacing 3.75 mm, frames of 1/60 s");
    std::vector<std::string> columns = {"tissue", "explicit steps a frame",
                                        "implicit: rounds, iterations a frame"};
    for (const std::string solver : kSolvers)
        for (const char* what : {", explicit", ", implicit", ", implicit over explicit"})
            columns.push_back(solver + what);
    std::vector<std::vector<std::string>> table;
    for (const Row& row : rows) {
        table.push_back({row.name, std::to_string(row.explicitSteps),
                         figure(double(row.effort.rounds) / kFrames) + ", " +
                             figure(double(row.effort.iterations) / kFrames)});
        for (const std::string& solver : solversOf(row)) {
            const double frame = 1e3 * app::kImplicitFrame; // ms
            const Spread times = rounds.ratio(solver + row.name, solver + " implicit" + row.name);
            table.back().push_back(figure(frame / rounds.milliseconds(solver + row.name).median));
            table.back().push_back(
                figure(kFrames * frame / rounds.milliseconds(solver + " implicit" + row.name).median));
            table.back().push_back(figure(
                Spread{kFrames * times.median, kFrames * times.min, kFrames * times.max, times.rounds}));
        }
        table.back().resize(columns.size(), "-");
    }
    report.table(columns, table);
    report.line("\nSimulated seconds a second of steps alone. Implicit: the first " +
                std::to_string(kFrames) + " frames from rest, in which the ball falls and swings.");
    return {};
}

} // namespace serosa::bench
