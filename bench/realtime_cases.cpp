// How many nodes keep up with time: a step's milliseconds grow with the nodes, the stable step with neither;
// so simulated seconds a second follow for every stiffness from one measurement.

#include "app/solver_choice.h"
#include "bench/cases.h"

#include <cmath>
#include <functional>
#include <map>

namespace serosa::bench {

namespace {

constexpr double kSpacing = 2e-3, kDensity = 1000; // m, kg/m3
constexpr double kYoung[] = {5000, 20000, 100000}; // Pa
constexpr std::size_t kNodes[] = {100, 300, 1000, 3000, 8000, 20000, 50000, 100000, 200000};
constexpr std::size_t kShown = 20000; // nodes of the column that is the same for all
constexpr const char* kSolvers[] = {"cpu", "fragment", "compute"};

/// One lattice size: what a step takes, and how far it goes.
struct Size {
    double nodes = 0;
    std::map<std::string, double> milliseconds; // by solver
    std::map<double, double> timeStep;          // s, by Young's modulus
};

double secondsASecond(const Size& size, const std::string& solver, double young) {
    return size.timeStep.at(young) / (1e-3 * size.milliseconds.at(solver));
}

/// Where simulated seconds a second, a power law between two sizes, come to 1.
std::string nodesInRealTime(const std::vector<Size>& sizes, const std::string& solver, double young) {
    if (secondsASecond(sizes.front(), solver, young) < 1)
        return "below " + figure(sizes.front().nodes);
    for (std::size_t i = 1; i < sizes.size(); ++i) {
        const double above = std::log(secondsASecond(sizes[i - 1], solver, young)),
                     below = std::log(secondsASecond(sizes[i], solver, young));
        if (below >= 0)
            continue;
        const double share = above / (above - below);
        return figure(
            std::exp(std::log(sizes[i - 1].nodes) * (1 - share) + std::log(sizes[i].nodes) * share));
    }
    return "above " + figure(sizes.back().nodes);
}

Result<Size> measure(sim::Lattice lattice, const Options& options) {
    lattice.spacing = kSpacing; // the same organ in another size
    Block block(std::move(lattice), kYoung[0], 1);
    block.setup.tissue.density = kDensity;
    Size size;
    size.nodes = double(block.lattice.nodeCount());
    for (const double young : kYoung) {
        block.setup.tissue.young = young;
        size.timeStep[young] = sim::stableStep(block.lattice, block.setup.tissue, 1.0 / 60).timeStep;
    }
    block.setup.timeStep = size.timeStep[block.setup.tissue.young];
    std::vector<std::unique_ptr<sim::Solver>> solvers;
    Rounds rounds;
    for (const char* name : kSolvers) {
        SEROSA_ASSIGN(std::unique_ptr<sim::Solver> solver, app::makeSolver(name, block.setup));
        solvers.push_back(std::move(solver));
        addSolver(rounds, name, *solvers.back());
    }
    rounds.measure(std::min(options.rounds, 3), options.seconds);
    for (const char* name : kSolvers)
        size.milliseconds[name] = rounds.milliseconds(name).median;
    return size;
}

} // namespace

Status benchRealtime(const Options& options, Report& report) {
    const std::pair<const char*, std::function<Result<sim::Lattice>(std::size_t)>> organs[] = {
        {"dense block",
         [](std::size_t nodes) { return denseLattice(int(std::lround(std::cbrt(double(nodes))))); }},
        {"heart", heartLattice}};
    std::vector<std::vector<std::string>> rows;
    for (const auto& [organ, lattice] : organs) {
        std::vector<Size> sizes;
        std::size_t shown = 0;
        for (const std::size_t nodes : kNodes) {
            if (nodes > options.largest)
                break;
            SEROSA_ASSIGN(sim::Lattice made, lattice(nodes));
            SEROSA_ASSIGN(Size size, measure(std::move(made), options));
            shown = nodes <= kShown ? sizes.size() : shown;
            sizes.push_back(std::move(size));
        }
        for (const char* solver : kSolvers)
            for (const double young : kYoung)
                rows.push_back({organ, solver, figure(1e-3 * young),
                                figure(1e3 * sizes[shown].timeStep.at(young)),
                                std::to_string(std::size_t(sizes[shown].nodes)),
                                figure(sizes[shown].milliseconds.at(solver)),
                                figure(secondsASecond(sizes[shown], solver, young)),
                                nodesInRealTime(sizes, solver, young)});
    }
    report.heading("Nodes in real time, spacing 2 mm, 1000 kg/m3, default damping");
    report.table({"organ", "solver", "Young's modulus, kPa", "step, ms", "nodes", "ms a step",
                  "simulated seconds a second", "nodes at 1"},
                 rows);
    report.line(
        "\nSteps alone, without drawing. The step is that of frames of 1/60 s. Between sizes the time "
        "follows a power law.");
    return {};
}

} // namespace serosa::bench
