// Part of group `implicit`: random organs, cuts and tools with implicit steps of 1/60 s. Each scenario
// follows from its seed (app/verify/random_scenario.h); its organ is that of the same seed in group
// `stability`.
#include "app/organ_guard.h"
#include "app/solver_choice.h"
#include "app/verify/random_scenario.h"
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
constexpr std::size_t kMostNodes = 3000;
constexpr int kFiner = 4;
// One of every so many scenarios is stepped in textures. This remainder begins with an organ whose tools are
// slow (1014): fast ones take up to 32 steps a frame, which are a matter of minutes without a GPU.
constexpr std::uint32_t kOnGpu = 20, kOnGpuRemainder = 14;

struct Outcome {
    std::uint32_t seed = 0;
    std::string words, failure; // failure empty: all is well
    bool finite = true;
    double energyShare = 0; // most
    std::size_t springsCut = 0;
    bool held = false, onGpu = false, pushed = false; // pushed: some tool pushes
};

/// The watchdog looks at every frame.
Result<Outcome> play(const RandomScenario& scenario, sim::Solver& solver, int frames) {
    Outcome outcome;
    outcome.words = scenario.words() + ", " + solver.name();
    sim::Watchdog watchdog(scenario.setup, scenario.step);
    solver.setState(scenario.start);
    watchdog.start(solver.state());
    const double frame = scenario.setup.timeStep * scenario.step.stepsPerFrame;
    sim::LatticeState state;
    for (int i = 1; i <= frames; ++i) {
        solver.advance(scenario.step.stepsPerFrame);
        watchdog.addWork((i - 1) * frame, i * frame, solver.takeLoads());
        SEROSA_TRY(scenario.cutFrame(solver, (i - 1) * frame, i * frame));
        state = solver.state();
        const std::optional<sim::Alarm> alarm = watchdog.check(state);
        outcome.energyShare = std::max(outcome.energyShare, watchdog.energyShare());
        outcome.held = outcome.held || std::any_of(state.heldBy.begin(), state.heldBy.end(),
                                                   [](std::uint32_t tool) { return tool != 0; });
        if (!alarm)
            continue;
        outcome.finite = alarm->kind != sim::AlarmKind::notFinite;
        outcome.failure = outcome.words + ": " + alarm->text();
        return outcome;
    }
    if (!state.connections.empty())
        outcome.springsCut = sim::springsCut(scenario.lattice, state.connections);
    return outcome;
}

/// Nothing where it is the other's turn. \param onGpu its turn is on the GPU: needs a context in this thread
/// \param finer so many steps in place of one
Result<Outcome> playSeed(const VerifyOptions& options, std::uint32_t seed, int frames, bool onGpu,
                         int finer = 1) {
    SEROSA_ASSIGN(const std::unique_ptr<RandomScenario> scenario,
                  randomScenario(seed, kMostNodes, frames, Wildness::damped, sim::StepMethod::implicit));
    if ((seed % kOnGpu == kOnGpuRemainder) != onGpu)
        return Outcome{};
    scenario->step.stepsPerFrame *= finer;
    scenario->setup.timeStep /= finer;
    for (glm::dvec3& increment : scenario->start.increments)
        increment /= finer;
    sim::SolverSetup setup = scenario->setup;
    if (options.inject.fault == Fault::stiffness) // the watchdog counts with the tissue as it was
        setup.tissue.young *= options.inject.factor;
    std::unique_ptr<sim::Solver> solver;
    if (onGpu) {
        SEROSA_ASSIGN(solver, makeSolver("compute", setup));
    } else {
        sim::CpuOptions one;
        one.threads = 1;
        solver = sim::makeCpuSolver(setup, one);
    }
    SEROSA_ASSIGN(Outcome outcome, play(*scenario, *solver, frames));
    outcome.seed = seed;
    outcome.onGpu = onGpu;
    outcome.pushed = std::any_of(setup.tools.begin(), setup.tools.end(),
                                 [](const sim::Tool& tool) { return tool.mode == sim::ToolMode::push; });
    return outcome;
}

Result<std::vector<Outcome>> playSeeds(const VerifyOptions& options, std::uint32_t count, int frames) {
    std::vector<Result<Outcome>> results(count, Outcome{});
    tbb::parallel_for(std::uint32_t(0), count, [&](std::uint32_t i) {
        results[i] = playSeed(options, kFirstSeed + i, frames, false);
    });
    std::vector<Outcome> outcomes;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (results[i] && results[i]->words.empty())
            results[i] = playSeed(options, kFirstSeed + i, frames, true);
        if (!results[i])
            return results[i].error();
        outcomes.push_back(*results[i]);
    }
    return outcomes;
}

} // namespace

Status verifyImplicitScenarios(const VerifyOptions& options, CheckList& checks) {
    const std::uint32_t count = options.full ? 200 : 20;
    const int frames = options.full ? 120 : 60;
    SEROSA_ASSIGN(const std::vector<Outcome> results, playSeeds(options, count, frames));
    double notFinite = 0, alarms = 0, share = 0, held = 0, onGpu = 0;
    std::size_t cut = 0;
    std::string failures;
    Outcome worst;
    for (const Outcome& result : results) {
        notFinite += !result.finite;
        held += result.held;
        onGpu += result.onGpu;
        cut += result.springsCut;
        // Fast tools crush cells in a step: what that takes is not in the loads (docs/methods/implicit.md).
        if (!result.pushed && result.energyShare > share) {
            share = result.energyShare;
            worst = result;
        }
        if (!result.failure.empty()) {
            ++alarms;
            failures += "; " + result.failure;
        }
    }
    const std::string of =
        std::to_string(count) + " random scenarios, " + std::to_string(frames) + " frames: ";
    checks.equalAbs(of + "states that are not finite", notFinite, 0, 0, "");
    checks.equalAbs(of + "stopped by the watchdog" + failures, alarms, 0, 0, "");
    // A long step keeps the energy of springs that turn and buckle to first order only: what is over must
    // vanish with the step.
    checks.atMost(of + "where no tool pushes, kinetic and elastic energy over what can have come in, most (" +
                      worst.words + ")",
                  share, 1.05, "1");
    SEROSA_ASSIGN(const Outcome finer, playSeed(options, worst.seed, frames, worst.onGpu, kFiner));
    checks.atMost(of + "the same scenario, four steps in place of one", finer.energyShare, 1, "1");
    checks.atLeast(of + "share in which a grasp held", held / count, 0.2, "1");
    checks.atLeast(of + "played on the GPU", onGpu, 1, "");
    checks.atLeast(of + "springs cut", double(cut), options.full ? 10000 : 1000, "");
    return {};
}

} // namespace serosa::app
