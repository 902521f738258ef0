// See app/pick_solver.h. A solver counts by the median of its times over the rounds.

#include "app/pick_solver.h"

#include "app/organ_setup.h"
#include "app/rounds.h"
#include "app/solver_choice.h"
#include "app/user_config.h"
#include "gpu/gl.h"
#include "models/phantom.h"

#include <algorithm>
#include <cstdio>
#include <ostream>

namespace serosa::app {

namespace {

constexpr std::size_t kFaces = 12000; // of the heart: its fewest, and enough for the lattice
constexpr int kAgreementSteps = 30;
constexpr double kAgreement = 1e-3; // h

double largestDifference(const sim::LatticeState& a, const sim::LatticeState& b) {
    double worst = 0;
    for (std::size_t node = 0; node < a.positions.size(); ++node) {
        const double apart = glm::distance(a.positions[node], b.positions[node]);
        worst = apart <= worst ? worst : apart; // a NaN stays
    }
    return worst;
}

struct Candidate {
    std::string name;
    std::unique_ptr<sim::Solver> solver;
    double apart = 0; // h, from the reference
};

Result<std::vector<Candidate>> makeCandidates(const sim::SolverSetup& setup) {
    std::vector<Candidate> candidates;
    sim::LatticeState expected;
    {
        SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> reference, makeSolver("reference", setup));
        reference->advance(kAgreementSteps);
        expected = reference->state();
    }
    for (const std::string& name : solverNames()) {
        Candidate candidate{name, nullptr, 0};
        SEROSA_ASSIGN(candidate.solver, makeSolver(name, setup));
        candidate.solver->advance(kAgreementSteps);
        candidate.apart = largestDifference(candidate.solver->state(), expected);
        candidates.push_back(std::move(candidate));
    }
    return candidates;
}

void printTable(const Rounds& rounds, const std::vector<Candidate>& candidates, const std::string& fastest,
                std::ostream& out) {
    char line[160];
    std::snprintf(line, sizeof line, "%-10s  %12s  %21s  %13s  %s\n", "solver", "ms a step",
                  "smallest-largest", "over fastest", "from reference, h");
    out << line;
    for (const Candidate& candidate : candidates) {
        const Spread time = rounds.milliseconds(candidate.name);
        const std::string range = shortNumber(time.min) + "-" + shortNumber(time.max);
        std::snprintf(line, sizeof line, "%-10s  %12.4g  %21s  %13.3g  %.2g\n", candidate.name.c_str(),
                      time.median, range.c_str(), rounds.ratio(candidate.name, fastest).median,
                      candidate.apart);
        out << line;
    }
}

} // namespace

Result<int> pickFastestSolver(const PickOptions& options, std::ostream& out) {
    SEROSA_ASSIGN(const std::filesystem::path file, userConfigFile());
    SEROSA_ASSIGN(const sim::Lattice lattice, models::phantomLattice("heart", kFaces, options.nodes));
    SEROSA_ASSIGN(const std::unique_ptr<gpu::Context> context, gpu::createContext(options.gl));
    sim::SolverSetup setup;
    setup.lattice = &lattice;
    setup.gravity = {0, -9.81, 0};
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(node.y == 0);
    out << "heart of " << grouped(lattice.nodeCount()) << " nodes; " << gpu::contextKindName(context->kind())
        << ", " << context->info().renderer << "\n"
        << std::flush;

    SEROSA_ASSIGN(std::vector<Candidate> candidates, makeCandidates(setup));
    for (const Candidate& candidate : candidates)
        if (!(candidate.apart <= kAgreement))
            return Error{"the " + candidate.name + " solver is " + shortNumber(candidate.apart) +
                             " h from the reference after " + std::to_string(kAgreementSteps) +
                             " steps: nothing was picked; 'serosa verify solver' says more",
                         exitCheckFailed};
    Rounds rounds;
    for (Candidate& candidate : candidates)
        rounds.add(candidate.name, [&solver = *candidate.solver](int repeats) {
            solver.advance(repeats);
            glFinish();
        });
    rounds.measure(options.rounds, options.seconds);
    const auto fastest =
        std::min_element(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
            return rounds.milliseconds(a.name).median < rounds.milliseconds(b.name).median;
        });
    printTable(rounds, candidates, fastest->name, out);
    SEROSA_TRY(writePickedSolver({fastest->name, lattice.nodeCount(), context->info().renderer}));
    out << "picked " << fastest->name << ": wrote " << file.string()
        << "; runs use it with --solver picked, and only then\n";
    return exitOk;
}

} // namespace serosa::app
