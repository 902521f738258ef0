// Contact inside implicit steps in compute passes, against the same in float32 on the processor: what holds
// there holds here, on both layouts with the same bytes.
#include "shaders/shared_constants.h"
#include "sim/implicit_solver.h"
#include "tests/gl_fixture.h"
#include "tests/sim/implicit_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

using test::block;
using test::floorOf;
using test::totalMass;

namespace {

class GlImplicitContact : public test::GlTest {};

std::unique_ptr<sim::Solver> onGpu(const SolverSetup& setup, int layout = -1) {
    return sim::makeImplicitTextureSolver(setup, "compute", layout).value();
}

} // namespace

TEST_F(GlImplicitContact, slidesAndRestsAsOnTheProcessor) {
    const double mu = 0.3;
    for (const double share : {0.9, 1.5}) {
        const Lattice lattice = block(5, 3, 4, 0.005);
        SolverSetup setup = test::implicitSetup(lattice, 20000);
        setup.tissue.dampingTime = 0.002;
        setup.bodies = {floorOf(mu)};
        const double angle = std::atan(share * mu);
        setup.gravity = 9.81 * glm::dvec3(std::sin(angle), -std::cos(angle), 0);
        const auto gpu = onGpu(setup), cpu = sim::makeImplicitCpuSolver(setup);
        for (sim::Solver* solver : {gpu.get(), cpu.get()}) {
            solver->setState(sim::startState(setup));
            solver->advance(15);
            solver->takeLoads();
            solver->advance(10);
        }
        const sim::ToolLoad given = gpu->takeLoads()[0], expected = cpu->takeLoads()[0];
        const double weight = 9.81 * totalMass(setup) / 6; // 10 frames'
        EXPECT_LT(glm::distance(given.impulse, expected.impulse), 5e-3 * weight) << share;
        EXPECT_NEAR(given.impulse.y, std::cos(angle) * weight, 5e-3 * weight) << share;
        const double moved = test::massCentre(lattice, cpu->state()).x,
                     here = test::massCentre(lattice, gpu->state()).x;
        EXPECT_NEAR(here, moved, 0.02 * std::max(0.2, std::abs(moved))) << share;
    }
}

TEST_F(GlImplicitContact, indentsAsTheProcessor) {
    const Lattice lattice = block(10, 5, 10, 0.003);
    SolverSetup setup = test::implicitSetup(lattice, 20000);
    setup.tissue.dampingTime = 0.002;
    test::fixWhere(setup, [](const glm::ivec3& node) { return node.y == 0; });
    const double radius = 0.015;
    const glm::dvec3 high = lattice.toWorld({0, 3, 0}) + glm::dvec3(0, radius, 0),
                     low = high - glm::dvec3(0, 0.004, 0);
    setup.tools = {{"ball", sim::ToolMode::push, radius, {{0, high}, {0.25, low}, {9, low}}}};
    setup.tools[0].friction = 0.2;
    const auto gpu = onGpu(setup), cpu = sim::makeImplicitCpuSolver(setup);
    for (sim::Solver* solver : {gpu.get(), cpu.get()}) {
        solver->setState(sim::startState(setup));
        solver->advance(24);
        solver->takeLoads();
        solver->advance(4);
    }
    const sim::ToolLoad given = gpu->takeLoads()[0], expected = cpu->takeLoads()[0];
    EXPECT_LT(expected.impulse.y, -4e-3);
    EXPECT_NEAR(given.impulse.y, expected.impulse.y, 3e-3 * std::abs(expected.impulse.y));
    EXPECT_LT(test::largestDistance(gpu->state(), cpu->state()), 0.01);
}

TEST_F(GlImplicitContact, graspsHoldTurnAndSlip) {
    const Lattice lattice = block(3, 6, 3, 0.003);
    SolverSetup setup = test::implicitSetup(lattice, 20000);
    setup.gravity = {0, -9.81, 0};
    const double weight = 9.81 * totalMass(setup);
    const glm::dvec3 top = lattice.toWorld({0, 3, 0});
    for (const double share : {3.0, 0.8, 1e9}) {
        setup.tools = {{"clamp", sim::ToolMode::grasp, 0.004, {{0, top}, {0.3, top}, {9, top}}}};
        setup.tools[0].keys[1].turn = setup.tools[0].keys[2].turn = glm::angleAxis(0.5, glm::dvec3(0, 1, 0));
        if (share < 1e6)
            setup.tools[0].gripForce = share * weight;
        const auto gpu = onGpu(setup), cpu = sim::makeImplicitCpuSolver(setup);
        std::size_t held[2] = {};
        sim::ToolLoad loads[2];
        for (int k = 0; k < 2; ++k) {
            sim::Solver& solver = k == 0 ? *gpu : *cpu;
            solver.setState(sim::startState(setup));
            solver.advance(36);
            solver.takeLoads();
            solver.advance(6);
            loads[k] = solver.takeLoads()[0];
            for (const std::uint32_t by : solver.state().heldBy)
                held[k] += by != 0;
        }
        EXPECT_EQ(held[0], held[1]) << share;
        EXPECT_EQ(held[0] > 0, share > 1) << share;
        EXPECT_NEAR(loads[0].impulse.y, share > 1 ? 0.1 * weight : 0, 5e-3 * weight) << share;
        EXPECT_LT(glm::distance(loads[0].angular, loads[1].angular), 5e-3 * weight * 0.01) << share;
        if (share > 1) {
            if (share > 1) {
                EXPECT_LT(test::largestDistance(gpu->state(), cpu->state()), 0.02) << share;
            }
        }
    }
}

TEST_F(GlImplicitContact, aGraspWithoutLimitKeepsItsNodes) {
    const Lattice lattice = block(4, 4, 4, 0.005);
    SolverSetup setup = test::implicitSetup(lattice, 2e4);
    const glm::dvec3 at = lattice.toWorld({2, 0, 0}), far = at + glm::dvec3(0.03, 0, 0);
    setup.tools = {{"grasp", sim::ToolMode::grasp, 0.006, {{0, at}, {9, at}}},
                   {"ball", sim::ToolMode::push, 0.012, {{0, far}, {0.25, at + glm::dvec3(0.009, 0, 0)}}}};
    const LatticeState start = sim::startState(setup);
    const auto solver = onGpu(setup);
    solver->setState(start);
    solver->advance(15);
    EXPECT_LT(solver->takeLoads()[1].impulse.x, 0);
    const LatticeState state = solver->state();
    std::size_t held = 0;
    for (std::size_t i = 0; i < state.heldBy.size(); ++i)
        if (state.heldBy[i] != 0) {
            ++held;
            EXPECT_LT(glm::distance(state.positions[i], start.positions[i]), 1e-6);
        }
    EXPECT_GE(held, 5u);
}

TEST_F(GlImplicitContact, layoutsAndRestoresKeepEveryByte) {
    const Lattice lattice = block(6, 4, 5, 0.005);
    SolverSetup setup = test::implicitSetup(lattice, 1e5);
    setup.bodies = {floorOf(0.3)};
    setup.gravity = {4, -9, 0};
    const glm::dvec3 top = lattice.toWorld({0, 2, 0});
    setup.tools = {
        {"ball", sim::ToolMode::push, 0.006, {{0, top + glm::dvec3(0, 0.012, 0)}, {0.3, top}, {9, top}}}};
    const auto grid = onGpu(setup, SRS_LAYOUT_GRID), rows = onGpu(setup, SRS_LAYOUT_ROWS);
    for (sim::Solver* solver : {grid.get(), rows.get()}) {
        solver->setState(sim::startState(setup));
        solver->advance(12);
    }
    EXPECT_EQ(grid->state().hash(), rows->state().hash());
    rows->setState(grid->state());
    for (sim::Solver* solver : {grid.get(), rows.get()})
        solver->advance(4);
    EXPECT_EQ(grid->state().hash(), rows->state().hash());
}
