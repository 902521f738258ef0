// Contact, friction and grasps of finite grip inside implicit steps of a whole frame: weights, Coulomb's law,
// and the explicit reference at rest.
#include "sim/cpu_solver.h"
#include "sim/implicit_solver.h"
#include "tests/sim/implicit_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

using test::block;
using test::fixWhere;
using test::floorOf;
using test::implicitSetup;
using test::kFrame;
using test::massCentre;
using test::totalMass;

namespace {

double lowest(const LatticeState& state) {
    double low = 1e9;
    for (const glm::dvec3& x : state.positions)
        low = std::min(low, x.y);
    return low;
}

glm::dvec3 meanIncrement(const Lattice& lattice, const LatticeState& state) {
    glm::dvec3 sum(0);
    double mass = 0;
    for (std::size_t i = 0; i < state.increments.size(); ++i) {
        sum += lattice.massShare(i) * state.increments[i];
        mass += lattice.massShare(i);
    }
    return sum / mass;
}

std::unique_ptr<sim::Solver> made(const SolverSetup& setup, bool exact) {
    return exact ? sim::makeReferenceSolver(setup) : sim::makeCpuSolver(setup);
}

} // namespace

TEST(ImplicitContact, restsOnAFloorWithItsWeight) {
    for (const double young : {1e3, 2e4, 1e6})
        for (const bool exact : {true, false}) {
            const Lattice lattice = block(6, 4, 5, 0.005);
            SolverSetup setup = implicitSetup(lattice, young);
            setup.gravity = {0, -9.81, 0};
            setup.bodies = {floorOf(0.3)};
            const auto solver = made(setup, exact);
            LatticeState state = sim::startState(setup);
            for (glm::dvec3& x : state.positions)
                x.y += 2; // 10 mm over the floor
            solver->setState(state);
            solver->advance(240);
            solver->takeLoads();
            const LatticeState before = solver->state();
            solver->advance(60);
            const glm::dvec3 impulse = solver->takeLoads()[0].impulse; // a second's
            const double weight = 9.81 * totalMass(setup);
            EXPECT_NEAR(impulse.y, weight, 1e-3 * weight) << young << exact;
            EXPECT_NEAR(impulse.x, 0, 1e-3 * weight) << young << exact;
            EXPECT_NEAR(lowest(before), -2, 1e-6) << young << exact; // on the floor, not in it
            EXPECT_LT(test::largestDistance(before, solver->state()), 1e-3) << young << exact;
        }
}

TEST(ImplicitContact, slidesFromTheTangentOn) {
    for (const double mu : {0.3, 0.8})
        for (const double young : {2e4, 1e6})
            for (const bool exact : {true, false})
                for (const double share : {0.95, 1.05, 1.5}) {
                    const Lattice lattice = block(8, 3, 6, 0.005);
                    SolverSetup setup = implicitSetup(lattice, young);
                    setup.tissue.dampingTime = 0.002;
                    setup.bodies = {floorOf(mu)};
                    const double angle = std::atan(share * mu);
                    setup.gravity = 9.81 * glm::dvec3(std::sin(angle), -std::cos(angle), 0);
                    const auto solver = made(setup, exact);
                    solver->setState(sim::startState(setup));
                    solver->advance(30);
                    const LatticeState before = solver->state();
                    solver->advance(30);
                    const LatticeState after = solver->state();
                    const double way = (massCentre(lattice, after) - massCentre(lattice, before)).x;
                    const double gain = meanIncrement(lattice, after).x - meanIncrement(lattice, before).x;
                    const double acceleration = gain * lattice.spacing / kFrame / (30 * kFrame),
                                 friction = std::tan(angle) - acceleration / (9.81 * std::cos(angle));
                    const std::string of =
                        ::testing::PrintToString(mu) + " " + ::testing::PrintToString(young) +
                        (exact ? " reference " : " cpu ") + ::testing::PrintToString(share);
                    if (share < 1) {
                        EXPECT_LT(std::abs(way), 0.02) << of; // spacings, in half a second
                    } else {
                        EXPECT_NEAR(friction, mu, 0.01 * mu) << of;
                        EXPECT_GT(way, 1) << of;
                    }
                }
}

TEST(ImplicitContact, indentsAsTheExplicitReference) {
    for (const double radius : {0.004, 0.015}) {
        const Lattice lattice = block(10, 5, 10, 0.003);
        SolverSetup setup = implicitSetup(lattice, 20000);
        setup.tissue.dampingTime = 0.002;
        fixWhere(setup, [](const glm::ivec3& node) { return node.y == 0; });
        const glm::dvec3 top = lattice.toWorld({0, 3, 0}), high = top + glm::dvec3(0, radius, 0),
                         low = high - glm::dvec3(0, 0.004, 0);
        setup.tools = {{"ball", sim::ToolMode::push, radius, {{0, high}, {0.5, low}, {9, low}}}};
        SolverSetup twin = setup;
        twin.method = sim::StepMethod::explicitSteps;
        twin.tissue.airDrag = 40;
        twin.timeStep = sim::stableStep(lattice, twin.tissue, kFrame).timeStep;
        const auto oracle = sim::makeCpuSolver(twin);
        oracle->setState(sim::startState(twin));
        oracle->advance(int(1 / twin.timeStep));
        oracle->takeLoads();
        oracle->advance(int(0.1 / twin.timeStep));
        const double expected = 10 * oracle->takeLoads()[0].impulse.y;
        EXPECT_LT(expected, -0.05);
        for (const bool exact : {true, false}) {
            const auto solver = made(setup, exact);
            solver->setState(sim::startState(setup));
            solver->advance(60);
            solver->takeLoads();
            solver->advance(6);
            // Under the small ball the explicit steps themselves stop up to 4% apart, as they came there.
            const double bound = radius < 2 * lattice.spacing ? 0.06 : 0.01;
            EXPECT_NEAR(10 * solver->takeLoads()[0].impulse.y, expected, bound * std::abs(expected))
                << radius << exact;
        }
    }
}

TEST(ImplicitContact, aFiniteGripSlipsAtItsForce) {
    for (const bool exact : {true, false})
        for (const double share : {1.1, 0.9}) {
            const Lattice lattice = block(3, 6, 3, 0.003);
            SolverSetup setup = implicitSetup(lattice, 20000);
            setup.gravity = {0, -9.81, 0};
            const double weight = 9.81 * totalMass(setup);
            const glm::dvec3 top = lattice.toWorld({0, 3, 0});
            setup.tools = {{"clamp", sim::ToolMode::grasp, 0.004, {{0, top}, {9, top}}}};
            setup.tools[0].gripForce = share * weight;
            const auto solver = made(setup, exact);
            solver->setState(sim::startState(setup));
            solver->advance(120);
            solver->takeLoads();
            solver->advance(60);
            const double force = solver->takeLoads()[0].impulse.y;
            std::size_t held = 0;
            for (const std::uint32_t by : solver->state().heldBy)
                held += by != 0;
            EXPECT_EQ(held > 0, share > 1) << exact;
            EXPECT_NEAR(force, share > 1 ? weight : 0, 2e-3 * weight) << exact;
        }
}

// What is pushed against a grasp gives way around it.
TEST(ImplicitContact, aGraspWithoutLimitKeepsItsNodes) {
    const Lattice lattice = block(6, 6, 6, 0.005);
    SolverSetup setup = implicitSetup(lattice, 2e4);
    const glm::dvec3 at = lattice.toWorld({3, 0, 0}), far = at + glm::dvec3(0.04, 0, 0);
    setup.tools = {{"grasp", sim::ToolMode::grasp, 0.006, {{0, at}, {9, at}}},
                   {"ball", sim::ToolMode::push, 0.012, {{0, far}, {0.5, at + glm::dvec3(0.009, 0, 0)}}}};
    for (const bool exact : {true, false}) {
        const auto solver = made(setup, exact);
        const LatticeState start = sim::startState(setup);
        solver->setState(start);
        solver->advance(30);
        EXPECT_LT(solver->takeLoads()[1].impulse.x, 0) << "the ball reaches the block";
        const LatticeState state = solver->state();
        std::size_t held = 0;
        for (std::size_t i = 0; i < state.heldBy.size(); ++i)
            if (state.heldBy[i] != 0) {
                ++held;
                EXPECT_LT(glm::distance(state.positions[i], start.positions[i]), 1e-6) << exact;
            }
        EXPECT_GE(held, 5u);
    }
}

TEST(ImplicitContact, stepsFollowTheFastestTool) {
    const auto steps = [](std::vector<sim::ToolKey> keys) {
        return sim::implicitStepsPerFrame({{"ball", sim::ToolMode::push, 0.01, std::move(keys)}}, 0.005,
                                          kFrame);
    };
    EXPECT_EQ(sim::implicitStepsPerFrame({}, 0.005, kFrame), 1);
    EXPECT_EQ(steps({{0, glm::dvec3(0)}, {1, {0.15, 0, 0}}}), 1); // 2.5 mm a frame: half a spacing
    EXPECT_EQ(steps({{0, glm::dvec3(0)}, {1, {0.16, 0, 0}}}), 2);
    EXPECT_EQ(steps({{0, glm::dvec3(0)}, {1, {0.9, 0, 0}}, {2, {0.9, 0, 0}}}), 6);
    EXPECT_EQ(steps({{0, glm::dvec3(0)}, {0.001, {0.006, 0, 0}}}), 3); // gone before the frame is over
    EXPECT_EQ(steps({{0, glm::dvec3(0)}, {1, {500, 0, 0}}}), sim::kMostImplicitSteps);
    // Half a turn a second of a ball of 10 mm: 0.52 mm a frame.
    EXPECT_EQ(steps({{0, glm::dvec3(0)}, {1, glm::dvec3(0), glm::dquat(0, 0, 0, 1)}}), 1);
    EXPECT_EQ(steps({{0, glm::dvec3(0)}, {0.1, glm::dvec3(0), glm::dquat(0, 0, 0, 1)}}), 3);
}

TEST(ImplicitContact, aToolGivesWhatAFreeOrganGains) {
    const Lattice lattice = block(6, 4, 5, 0.005);
    SolverSetup setup = implicitSetup(lattice, 2e4);
    setup.tissue.dampingTime = 0.002;
    const glm::dvec3 side = lattice.toWorld({-3, 0.3, 0.2});
    setup.tools = {
        {"ball",
         sim::ToolMode::push,
         0.012,
         {{0, side - glm::dvec3(0.02, 0, 0)}, {0.3, side + glm::dvec3(0.02, 0, 0)}, {0.5, side}, {9, side}}}};
    setup.tools[0].friction = 0.5;
    for (const bool exact : {true, false}) {
        const auto solver = made(setup, exact);
        solver->setState(sim::startState(setup));
        solver->advance(60);
        const glm::dvec3 impulse = solver->takeLoads()[0].impulse,
                         gained = meanIncrement(lattice, solver->state()) * totalMass(setup) *
                                  lattice.spacing / kFrame;
        EXPECT_GT(impulse.x, 0);
        EXPECT_LT(glm::distance(impulse, gained), (exact ? 0.01 : 0.02) * glm::length(impulse))
            << exact << impulse.x << " " << gained.x;
    }
}

TEST(ImplicitContact, goesOnFromAStateWithTheSameBytes) {
    const Lattice lattice = block(6, 4, 5, 0.005);
    SolverSetup setup = implicitSetup(lattice, 1e5);
    setup.bodies = {floorOf(0.3)};
    setup.gravity = {4, -9, 0};
    for (const bool exact : {true, false}) {
        const auto first = made(setup, exact), second = made(setup, exact);
        first->setState(sim::startState(setup));
        first->advance(20);
        second->setState(first->state());
        first->advance(10);
        second->advance(10);
        EXPECT_EQ(first->state().hash(), second->state().hash()) << exact;
    }
}
