// Group `stability`: nothing that a scene can ask for makes a state run away, and the step's bound is one.
// Each scenario follows from its seed (app/verify/random_scenario.h), which stands in the name of a check
// that fails.
#include "app/organ_guard.h"
#include "app/solver_choice.h"
#include "app/verify/random_scenario.h"
#include "app/verify/true_step.h"
#include "app/verify/verify.h"
#include "sim/cpu_solver.h"
#include "sim/pieces.h"
#include "sim/watchdog.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

constexpr std::uint32_t kFirstSeed = 1000;
constexpr int kStepsAFrame = 20; // between cuts; the watchdog looks every kFramesBetweenChecks of them
constexpr std::size_t kMostNodes = 3000;
constexpr std::uint32_t kOnGpu =
    4; // of the scenarios with a volumetric term every fourth is stepped in textures

struct Outcome {
    std::string failure; // empty: all is well
    std::string words;
    bool finite = true;
    double energyShare = 0, fastestTool = 0; // largest; m/s
    std::size_t springsCut = 0;
    bool touched = false, volumetric = false;
};

Result<Outcome> play(const RandomScenario& scenario, sim::Solver& solver, int steps) {
    Outcome outcome;
    outcome.words = scenario.words() + ", " + solver.name();
    outcome.volumetric = scenario.setup.tissue.volumetric();
    for (const sim::Tool& tool : scenario.setup.tools)
        for (std::size_t key = 1; key < tool.keys.size(); ++key)
            outcome.fastestTool =
                std::max(outcome.fastestTool, glm::length(tool.keys[key].at - tool.keys[key - 1].at) /
                                                  (tool.keys[key].time - tool.keys[key - 1].time));
    sim::Watchdog watchdog(scenario.setup, scenario.step);
    solver.setState(scenario.start);
    watchdog.start(solver.state());
    const double frame = kStepsAFrame * scenario.setup.timeStep;
    for (int i = 1; i * kStepsAFrame <= steps; ++i) {
        solver.advance(kStepsAFrame);
        const std::vector<sim::ToolLoad> loads = solver.takeLoads();
        watchdog.addWork((i - 1) * frame, i * frame, loads);
        for (const sim::ToolLoad& load : loads)
            outcome.touched = outcome.touched || load.impulse != glm::dvec3(0);
        SEROSA_TRY(scenario.cutFrame(solver, (i - 1) * frame, i * frame));
        if (i % kFramesBetweenChecks != 0 && (i + 1) * kStepsAFrame <= steps)
            continue;
        const sim::LatticeState state = solver.state();
        const std::optional<sim::Alarm> alarm = watchdog.check(state);
        outcome.energyShare = std::max(outcome.energyShare, watchdog.energyShare());
        if (!alarm)
            continue;
        outcome.finite = alarm->kind != sim::AlarmKind::notFinite;
        outcome.failure = outcome.words + ": " + alarm->text();
        return outcome;
    }
    const sim::LatticeState last = solver.state();
    if (!last.connections.empty())
        outcome.springsCut = sim::springsCut(scenario.lattice, last.connections);
    return outcome;
}

/// A scenario on the solver that suits it. \param onGpu its turn is on the GPU: needs a context in this
/// thread.
Result<Outcome> playSeed(const VerifyOptions& options, std::uint32_t seed, int steps, Wildness wildness,
                         bool onGpu) {
    SEROSA_ASSIGN(const std::unique_ptr<RandomScenario> scenario,
                  randomScenario(seed, kMostNodes, steps, wildness));
    if ((seed % kOnGpu == 0) != onGpu)
        return Outcome{};
    sim::SolverSetup setup = scenario->setup;
    if (options.inject.fault == Fault::stiffness) // the step stays that of the tissue as it was
        setup.tissue.young *= options.inject.factor;
    std::unique_ptr<sim::Solver> solver;
    if (onGpu) {
        SEROSA_ASSIGN(solver, makeSolver("fragment", setup));
    } else {
        sim::CpuOptions one;
        one.threads = 1;
        solver = sim::makeCpuSolver(setup, one);
    }
    return play(*scenario, *solver, steps);
}

Result<std::vector<Outcome>> playSeeds(const VerifyOptions& options, std::uint32_t count, int steps,
                                       Wildness wildness) {
    std::vector<Result<Outcome>> results(count, Outcome{});
    tbb::parallel_for(std::uint32_t(0), count, [&](std::uint32_t i) {
        results[i] = playSeed(options, kFirstSeed + i, steps, wildness, false);
    });
    std::vector<Outcome> outcomes;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (results[i] && results[i]->words.empty())
            results[i] = playSeed(options, kFirstSeed + i, steps, wildness, true);
        if (!results[i])
            return results[i].error();
        outcomes.push_back(*results[i]);
    }
    return outcomes;
}

Status scenarios(const VerifyOptions& options, CheckList& checks) {
    const std::uint32_t count = options.full ? 200 : 20;
    const int steps = options.full ? 10000 : 500;
    SEROSA_ASSIGN(const std::vector<Outcome> results, playSeeds(options, count, steps, Wildness::damped));
    double notFinite = 0, alarms = 0, share = 0, touched = 0, volumetric = 0, fastest = 0;
    std::size_t cut = 0;
    std::string failures, worst;
    for (const Outcome& result : results) {
        notFinite += !result.finite;
        touched += result.touched;
        volumetric += result.volumetric;
        cut += result.springsCut;
        fastest = std::max(fastest, result.fastestTool);
        if (result.energyShare > share) {
            share = result.energyShare;
            worst = result.words;
        }
        if (!result.failure.empty()) {
            ++alarms;
            failures += "; " + result.failure;
        }
    }
    const std::string of = std::to_string(count) + " random scenarios, " + std::to_string(steps) + " steps: ";
    checks.equalAbs(of + "states that are not finite", notFinite, 0, 0, "");
    checks.equalAbs(of + "stopped by the watchdog" + failures, alarms, 0, 0, "");
    checks.atMost(of + "kinetic and elastic energy over what can have come in, most (" + worst + ")", share,
                  4, "1");
    checks.atLeast(of + "share in which a tool touched", touched / count, 0.5, "1");
    checks.atLeast(of + "share with a volumetric term", volumetric / count, 0.4, "1");
    checks.atLeast(of + "springs cut", double(cut), options.full ? 10000 : 1000, "");
    checks.equalAbs(of + "fastest tool", fastest, 1, 1e-6, "m/s");
    return {};
}

Status stepBounds(const VerifyOptions& options, CheckList& checks) {
    const std::uint32_t count = 100;
    const std::size_t mostNodes = options.full ? kMostNodes : 250;
    struct Ratio {
        double share = 0, residual = 0;
        std::string words;
        Status status;
    };
    std::vector<Ratio> ratios(count);
    tbb::parallel_for(std::uint32_t(0), count, [&](std::uint32_t i) {
        Random random(kFirstSeed + i);
        Result<sim::Lattice> lattice = randomLattice(random, mostNodes);
        if (!lattice.ok()) {
            ratios[i].status = lattice.error();
            return;
        }
        sim::Tissue tissue = randomTissue(random, Wildness::any);
        paintMaterials(random, tissue, *lattice);
        const double bound = sim::stableStep(*lattice, tissue, 1).bound;
        if (options.inject.fault == Fault::stiffness)
            tissue.young *= options.inject.factor;
        const TrueStep step = trueStep(*lattice, tissue);
        ratios[i].share = bound / step.bound;
        ratios[i].residual = step.residual;
        ratios[i].words = "seed " + std::to_string(kFirstSeed + i) + ", " +
                          std::to_string(lattice->nodeCount()) + " nodes, nu " +
                          std::to_string(tissue.poisson);
    });
    for (const Ratio& ratio : ratios)
        SEROSA_TRY(ratio.status);
    const auto less = [](const Ratio& a, const Ratio& b) { return a.share < b.share; };
    const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end(), less);
    double residual = 0;
    for (const Ratio& ratio : ratios)
        residual = std::max(residual, ratio.residual);
    checks.atMost("100 random organs: step bound / true bound, most (" + most->words + ")", most->share, 1,
                  "1");
    checks.atLeast("100 random organs: step bound / true bound, least (" + least->words + ")", least->share,
                   0.7, "1");
    checks.atMost("100 random organs: what the true bound's eigenvalue lacks to have converged", residual,
                  1e-6, "1");
    return {};
}

} // namespace

Status verifyStability(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(stepBounds(options, checks));
    return scenarios(options, checks);
}

} // namespace serosa::app
