// The watchdog: it accounts for what tools put in, says nothing where nothing is wrong, and names node and
// reason where something is, before numbers become infinite.
#include "sim/cpu_solver.h"
#include "sim/watchdog.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace serosa;
using sim::AlarmKind;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;
using sim::Watchdog;

namespace {

/// Undamped: nothing but tools changes its energy.
SolverSetup setupOf(const Lattice& lattice) {
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue.dampingTime = 0;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
    return setup;
}

sim::StableStep stepOf(const SolverSetup& setup) {
    return sim::stableStep(*setup.lattice, setup.tissue, 1.0 / 60);
}

LatticeState stirred(const Lattice& lattice, double size) {
    LatticeState state = sim::restState(lattice);
    std::mt19937 random(5);
    for (glm::dvec3& u : state.increments)
        for (int axis = 0; axis < 3; ++axis)
            u[axis] = size * (double(random()) / 2147483648.0 - 1);
    return state;
}

} // namespace

// No more elastic and kinetic energy is in an undamped block than its tools put in. All of it is where they
// hold nodes; a push takes some, as every touch is inelastic. Steps of a tenth, so that half a step between
// positions and increments does not blur it.
TEST(Watchdog, WorkOfToolsIsTheEnergyThatComesIn) {
    const Lattice lattice = test::blockLattice(5, 5, 5);
    for (const sim::ToolMode mode : {sim::ToolMode::push, sim::ToolMode::grasp}) {
        SolverSetup setup = setupOf(lattice);
        setup.timeStep /= 10;
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(node.y == 0);
        const glm::dvec3 from(0.0005, mode == sim::ToolMode::push ? 0.0215 : 0.0075, 0),
            to = from - glm::dvec3(0.001, 0.005, 0);
        setup.tools = {{"tool", mode, 0.006, {{0, from}, {0.2, to}, {0.3, from}, {0.4, to}}}};
        Watchdog watchdog(setup, stepOf(setup));
        const auto solver = sim::makeReferenceSolver(setup);
        solver->setState(sim::startState(setup));
        watchdog.start(solver->state());
        const int every = 20;
        double most = 0;
        for (int step = 0; (step + every) * setup.timeStep < 0.4; step += every) {
            solver->advance(every);
            watchdog.addWork(step * setup.timeStep, (step + every) * setup.timeStep, solver->takeLoads());
            const auto alarm = watchdog.check(solver->state());
            ASSERT_FALSE(alarm) << alarm->text();
            most = std::max(most, watchdog.energyShare());
        }
        EXPECT_LT(most, 1.05) << int(mode);
        EXPECT_GT(most, 0.9) << int(mode);
    }
}

TEST(Watchdog, NamesTheNodeThatIsNotFinite) {
    const Lattice lattice = test::blockLattice(3, 3, 3);
    const SolverSetup setup = setupOf(lattice);
    for (const bool increment : {false, true}) {
        Watchdog watchdog(setup, stepOf(setup));
        LatticeState state = sim::restState(lattice);
        watchdog.start(state);
        EXPECT_FALSE(watchdog.check(state));
        state.step = 40;
        (increment ? state.increments : state.positions)[17].y = std::numeric_limits<double>::quiet_NaN();
        const auto alarm = watchdog.check(state);
        ASSERT_TRUE(alarm);
        EXPECT_EQ(alarm->kind, AlarmKind::notFinite);
        EXPECT_EQ(alarm->node, 17u);
        EXPECT_DOUBLE_EQ(alarm->time, 40 * setup.timeStep);
        EXPECT_NE(alarm->text().find("node 17 at "), std::string::npos);
    }
}

TEST(Watchdog, StopsAStepBeyondTheBoundEarly) {
    const Lattice lattice = test::blockLattice(6, 6, 6);
    SolverSetup setup = setupOf(lattice);
    for (const bool cpu : {false, true}) {
        SolverSetup tooLong = setup;
        tooLong.timeStep = 1.05 * stepOf(setup).bound;
        Watchdog watchdog(tooLong, stepOf(setup));
        const auto solver = cpu ? sim::makeCpuSolver(tooLong) : sim::makeReferenceSolver(tooLong);
        solver->setState(stirred(lattice, 0.01));
        watchdog.start(solver->state());
        std::optional<sim::Alarm> alarm;
        while (!alarm && solver->state().step < 2000) {
            solver->advance(1);
            alarm = watchdog.check(solver->state());
        }
        ASSERT_TRUE(alarm);
        EXPECT_NE(alarm->kind, AlarmKind::notFinite);
        EXPECT_GT(alarm->measured, alarm->allowed);
        double farthest = 0;
        const LatticeState state = solver->state();
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            farthest = std::max(farthest, glm::length(state.positions[node] - lattice.restPosition(node)));
        EXPECT_LT(farthest, 2) << "spacings: before the picture shows it";
    }
}

TEST(Watchdog, AStableStepWithTheSameStartGoesOn) {
    const Lattice lattice = test::blockLattice(6, 6, 6);
    const SolverSetup setup = setupOf(lattice);
    Watchdog watchdog(setup, stepOf(setup));
    const auto solver = sim::makeReferenceSolver(setup);
    solver->setState(stirred(lattice, 0.05));
    watchdog.start(solver->state());
    for (int i = 0; i < 200; ++i) {
        solver->advance(10);
        const auto alarm = watchdog.check(solver->state());
        ASSERT_FALSE(alarm) << alarm->text();
    }
}

// What no explicit step could follow is no reason to stop an implicit one; energy that runs away is, and so
// is what is no number.
TEST(Watchdog, KnowsNoStepBoundOfImplicitSteps) {
    const Lattice lattice = test::blockLattice(4, 4, 4);
    SolverSetup setup = setupOf(lattice);
    setup.timeStep = 1.0 / 60;
    LatticeState state = stirred(lattice, 0.6);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        state.positions[node] = 4.0 * lattice.restPosition(node);
    for (const bool runsAway : {false, true}) {
        setup.tissue.young = runsAway ? 1 : 5000; // moving most, or stretched most
        setup.method = sim::StepMethod::explicitSteps;
        Watchdog ofExplicit(setup, stepOf(setup));
        setup.method = sim::StepMethod::implicit;
        Watchdog ofImplicit(setup, stepOf(setup));
        LatticeState later = state;
        for (glm::dvec3& u : later.increments)
            u *= runsAway ? 10 : 1.2;
        ofExplicit.start(state);
        const auto step = ofExplicit.check(later);
        ASSERT_TRUE(step);
        EXPECT_EQ(step->kind, runsAway ? AlarmKind::energy : AlarmKind::step);
        ofImplicit.start(state);
        const auto alarm = ofImplicit.check(later);
        ASSERT_EQ(alarm.has_value(), runsAway);
        if (alarm) {
            EXPECT_EQ(alarm->kind, AlarmKind::energy);
        }
        later.increments[7].y = std::numeric_limits<double>::quiet_NaN();
        const auto broken = ofImplicit.check(later);
        ASSERT_TRUE(broken);
        EXPECT_EQ(broken->kind, AlarmKind::notFinite);
        EXPECT_EQ(broken->node, 7U);
    }
}

// On all sides drawn out by s, a node inside or on a face resists 1 + 2 (1 - 1/s) times as much as at rest;
// along one axis by 6 less than twice as much.
TEST(Watchdog, SaysWhatStepAStretchedStateNeeds) {
    const Lattice lattice = test::blockLattice(4, 4, 4);
    const SolverSetup setup = setupOf(lattice);
    const sim::StableStep step = stepOf(setup);
    const double s = 4;
    for (const bool allSides : {false, true}) {
        Watchdog watchdog(setup, step);
        LatticeState state = stirred(lattice, 0.6);
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            state.positions[node] =
                lattice.restPosition(node) * (allSides ? glm::dvec3(s) : glm::dvec3(1.5 * s, 1, 1));
        watchdog.start(state);
        for (glm::dvec3& u : state.increments)
            u *= 1.2; // a little more energy than can have come in
        const auto alarm = watchdog.check(state);
        ASSERT_EQ(alarm.has_value(), allSides);
        if (!alarm)
            continue;
        EXPECT_EQ(alarm->kind, AlarmKind::step);
        const glm::ivec3 at = lattice.nodes[alarm->node];
        int faces = 0; // half the springs and half the mass on a face, the same rate
        for (int axis = 0; axis < 3; ++axis)
            faces += at[axis] == 0 || at[axis] == 4;
        EXPECT_LE(faces, 1);
        const double rate2 = step.stiffestRate2 + 2 * (1 - 1 / s) * step.springRate2;
        EXPECT_NEAR(alarm->allowed * std::sqrt(rate2) / 2, 1, 1e-9);
        EXPECT_EQ(alarm->measured, setup.timeStep);
    }
}
