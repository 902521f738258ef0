// The implicit step in double and on the processor's cores: closed forms, conservation laws, and the explicit
// reference with small steps.
#include "sim/cpu_solver.h"
#include "sim/implicit_solver.h"
#include "tests/sim/implicit_bodies.h"
#include "tests/sim/materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

using test::capsuleLattice;
using test::capsuleSetup;
using test::fixWhere;
using test::implicitSetup;
using test::kFrame;
using test::largestDistance;
using test::massCentre;

namespace {

/// Of the same body, so much longer than the first step that its waves have died out.
LatticeState settled(const SolverSetup& setup, int steps) {
    const auto solver = sim::makeReferenceSolver(setup);
    solver->setState(sim::startState(setup));
    solver->advance(steps);
    return solver->state();
}

SolverSetup explicitTwin(SolverSetup setup, double airDrag) {
    setup.method = sim::StepMethod::explicitSteps;
    setup.tissue.airDrag = airDrag;
    setup.timeStep = sim::stableStep(*setup.lattice, setup.tissue, kFrame).timeStep;
    return setup;
}

} // namespace

TEST(ImplicitSolver, fallsFreelyAsInVacuum) {
    const Lattice lattice = test::blockLattice(3, 2, 2);
    SolverSetup setup = implicitSetup(lattice, 1e6);
    setup.gravity = {0, -9.81, 0};
    const LatticeState end = settled(setup, 30);
    const double fallen = 9.81 * 0.25 / 2 / lattice.spacing; // 0.5 s
    for (std::size_t i = 0; i < lattice.nodeCount(); ++i)
        EXPECT_LT(glm::distance(end.positions[i], lattice.restPosition(i) - glm::dvec3(0, fallen, 0)),
                  1e-6 * fallen);
}

TEST(ImplicitSolver, keepsMomentumAndBarelyBrakesASpin) {
    const Lattice lattice = test::blockLattice(6, 3, 2);
    const SolverSetup setup = implicitSetup(lattice, 1e5);
    const auto solver = sim::makeReferenceSolver(setup);
    LatticeState state = sim::restState(lattice);
    const glm::dvec3 drift(0.2, 0.1, -0.05), spin(0, 0, 0.1); // a radian in ten frames
    for (std::size_t i = 0; i < lattice.nodeCount(); ++i)
        state.increments[i] = drift + glm::cross(spin, state.positions[i] - massCentre(lattice, state));
    solver->setState(state);
    const glm::dvec3 start = massCentre(lattice, state);
    solver->advance(100);
    state = solver->state();
    EXPECT_LT(glm::distance(massCentre(lattice, state), start + 100.0 * drift), 1e-5);
    glm::dvec3 turning(0);
    double inertia = 0;
    for (std::size_t i = 0; i < lattice.nodeCount(); ++i) {
        const glm::dvec3 from = state.positions[i] - massCentre(lattice, state);
        turning += lattice.massShare(i) * glm::cross(from, state.increments[i]);
        inertia += lattice.massShare(i) * (from.x * from.x + from.y * from.y);
    }
    EXPECT_GT(turning.z / inertia, 0.09);
    EXPECT_LT(turning.z / inertia, 0.1);
}

TEST(ImplicitSolver, errorFallsWithTheSquareOfTheStep) {
    const Lattice lattice = test::blockLattice(8, 2, 2, 0.005);
    SolverSetup setup = implicitSetup(lattice, 20000);
    setup.gravity = {0, -9.81, 0};
    fixWhere(setup, [](const glm::ivec3& node) { return node.x == 0; });
    const double end = 0.15;
    const auto after = [&](SolverSetup of, int steps) {
        of.timeStep = end / steps;
        return settled(of, steps);
    };
    SolverSetup fine = setup;
    fine.method = sim::StepMethod::explicitSteps;
    const LatticeState exact = after(fine, 16000); // its own error must not show
    const double coarse = largestDistance(after(setup, 150), exact),
                 half = largestDistance(after(setup, 300), exact),
                 quarter = largestDistance(after(setup, 600), exact);
    EXPECT_GT(coarse, 0.02); // there is an error to fall
    EXPECT_GT(std::log2(coarse / half), 1.7) << coarse << " " << half;
    // Modes that are hardly resolved fall more slowly: the mean of both halvings.
    EXPECT_GT(0.5 * std::log2(coarse / quarter), 1.65) << coarse << " " << half << " " << quarter;
}

TEST(ImplicitSolver, hangsAsTheExplicitReferenceAtRest) {
    const Lattice lattice = test::blockLattice(8, 3, 3, 0.005);
    for (const double poisson : {0.25, 0.45}) {
        SolverSetup setup = implicitSetup(lattice, 20000);
        setup.tissue.poisson = poisson;
        setup.gravity = {0, -9.81, 0};
        fixWhere(setup, [](const glm::ivec3& node) { return node.x == 0; });
        const SolverSetup twin = explicitTwin(setup, 20);
        const LatticeState expected = settled(twin, int(3 / twin.timeStep)), found = settled(setup, 300);
        const double sag = largestDistance(expected, sim::restState(lattice));
        EXPECT_GT(sag, 0.5);
        EXPECT_LT(largestDistance(found, expected), 1e-3 * sag) << poisson;
        // On all cores in float32, solved no further than a frame allows.
        const auto cpu = sim::makeCpuSolver(setup);
        cpu->setState(sim::startState(setup));
        cpu->advance(300);
        EXPECT_LT(largestDistance(cpu->state(), expected), 2e-3 * sag) << poisson;
    }
}

TEST(ImplicitSolver, aStiffPendulumSwingsOn) {
    const Lattice lattice = test::blockLattice(12, 3, 3, 0.01);
    SolverSetup setup = implicitSetup(lattice, 1e6);
    setup.tissue.dampingTime = 0.0005;
    setup.gravity = {0, -9.81, 0};
    fixWhere(setup, [](const glm::ivec3& node) { return node.x == 0 && node.y == 3; });
    const glm::dvec3 hinge = lattice.toLattice({0, 0.03, 0.015});
    for (const bool exact : {true, false}) {
        const auto solver = exact ? sim::makeReferenceSolver(setup) : sim::makeCpuSolver(setup);
        solver->setState(sim::startState(setup));
        const auto angle = [&] {
            const glm::dvec3 from = massCentre(lattice, solver->state()) - hinge;
            return std::atan2(from.x, -from.y);
        };
        const double start = angle();
        double least = start, back = 0;
        for (int frame = 0; frame < 55; ++frame) { // more than one period, less than two
            solver->advance(1);
            least = std::min(least, angle());
            if (least < -0.5)
                back = std::max(back, angle());
        }
        EXPECT_GT(start, 1.2);
        EXPECT_LT(least, -0.9 * start);
        EXPECT_GT(back, (exact ? 0.87 : 0.84) * start);
        EXPECT_LT(back, start);
    }
}

TEST(ImplicitSolver, aStiffCapsuleAroundSoftTissueIsStable) {
    const Lattice lattice = capsuleLattice(12);
    const SolverSetup setup = capsuleSetup(lattice);
    const SolverSetup twin = explicitTwin(setup, 100);
    EXPECT_GT(kFrame / twin.timeStep, 1000); // what explicit steps would take
    const auto solver = sim::makeCpuSolver(setup);
    LatticeState state = sim::startState(setup);
    solver->setState(state);
    const sim::Energies start = sim::energies(setup, sim::restState(lattice));
    for (int frame = 0; frame < 300; ++frame) {
        solver->advance(1);
        const sim::Energies now = sim::energies(setup, solver->state());
        ASSERT_LT(now.kinetic + now.elastic + now.gravitational, start.gravitational + 1e-9) << frame;
    }
    // The static solution of the same springs, with small steps in a rounder way.
    const LatticeState expected = settled(setup, 200);
    EXPECT_LT(largestDistance(solver->state(), expected),
              0.01 * largestDistance(expected, sim::restState(lattice)));
}

TEST(ImplicitSolver, whatAGraspHoldsHangsWithItsWeight) {
    const Lattice lattice = test::blockLattice(3, 6, 3);
    SolverSetup setup = implicitSetup(lattice, 20000);
    setup.gravity = {0, -9.81, 0};
    const glm::dvec3 top = lattice.toWorld(lattice.restPosition(lattice.nodeCount() - 1));
    setup.tools = {{"clamp",
                    sim::ToolMode::grasp,
                    0.004,
                    {{0, top}, {1, top + glm::dvec3(0, 0.01, 0)}, {9, top + glm::dvec3(0, 0.01, 0)}}}};
    const double mass = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < lattice.nodeCount(); ++i)
            sum += lattice.massShare(i);
        return sum * setup.tissue.nodeMass(lattice.spacing);
    }();
    for (const bool exact : {true, false}) {
        const auto solver = exact ? sim::makeReferenceSolver(setup) : sim::makeCpuSolver(setup);
        solver->setState(sim::startState(setup));
        solver->advance(300);
        std::size_t held = 0;
        const LatticeState state = solver->state();
        for (std::size_t i = 0; i < lattice.nodeCount(); ++i)
            if (state.heldBy[i] == 1) {
                ++held;
                EXPECT_LT(glm::distance(state.positions[i],
                                        lattice.restPosition(i) + glm::dvec3(0, 0.01 / lattice.spacing, 0)),
                          1e-5);
            }
        EXPECT_GT(held, 3U);
        solver->takeLoads();
        solver->advance(60);
        const glm::dvec3 impulse = solver->takeLoads().front().impulse; // a second's
        EXPECT_NEAR(impulse.y, mass * 9.81, 2e-3 * mass * 9.81);
        EXPECT_NEAR(impulse.x, 0, 2e-3 * mass * 9.81);
    }
}

TEST(ImplicitSolver, goesOnFromAStateWithTheSameBytes) {
    const Lattice lattice = capsuleLattice(8);
    const SolverSetup setup = capsuleSetup(lattice);
    for (const bool exact : {true, false}) {
        const auto made = [&] { return exact ? sim::makeReferenceSolver(setup) : sim::makeCpuSolver(setup); };
        const auto first = made(), second = made();
        first->setState(sim::startState(setup));
        first->advance(7);
        second->setState(first->state());
        first->advance(5);
        second->advance(5);
        EXPECT_EQ(first->state().hash(), second->state().hash());
        LatticeState forgetful = first->state();
        forgetful.earlier.clear();
        EXPECT_NE(forgetful.hash(), first->state().hash());
    }
}

TEST(ImplicitSolver, threadsChangeNoByte) {
    const Lattice lattice = capsuleLattice(14);
    const SolverSetup setup = capsuleSetup(lattice);
    std::string hash;
    for (const int threads : {1, 2, 5}) {
        const auto solver = sim::makeCpuSolver(setup, {threads});
        solver->setState(sim::startState(setup));
        solver->advance(4);
        if (hash.empty())
            hash = solver->state().hash();
        EXPECT_EQ(solver->state().hash(), hash) << threads;
    }
}

TEST(ImplicitSolver, survivesTearsCutsAndAViolentGrasp) {
    const Lattice lattice = test::patchedLattice(7, 4);
    for (const bool stiff : {false, true}) {
        SolverSetup setup = implicitSetup(lattice, 1000);
        setup.tissue = test::threeMaterials();
        if (stiff)
            setup.tissue.others[1].young = setup.tissue.others[1].fibreYoung = 1e6;
        setup.gravity = {0, -9.81, 0};
        fixWhere(setup, [](const glm::ivec3& node) { return node.y == 0; });
        const glm::dvec3 top = lattice.toWorld(lattice.restPosition(lattice.nodeCount() - 1));
        setup.tools = {{"clamp",
                        sim::ToolMode::grasp,
                        0.006,
                        {{0.1, top},
                         {0.2, top + glm::dvec3(0.1, 0, 0)},
                         {0.3, top - glm::dvec3(0.1, 0, 0)},
                         {0.5, top}}}}; // 1 and 2 m/s
        for (const bool exact : {true, false}) {
            const auto solver = exact ? sim::makeReferenceSolver(setup) : sim::makeCpuSolver(setup);
            solver->setState(sim::startState(setup));
            sim::Stroke tear;
            tear.kind = sim::StrokeKind::tear;
            tear.strain = 2;
            for (int frame = 0; frame < 60; ++frame) {
                solver->advance(1);
                if (frame == 14) {
                    ASSERT_TRUE(solver->cut(tear).ok());
                }
            }
            const LatticeState state = solver->state();
            double fastest = 0;
            for (std::size_t i = 0; i < lattice.nodeCount(); ++i) {
                ASSERT_TRUE(std::isfinite(glm::length(state.positions[i])));
                fastest = std::max(fastest, glm::length(state.increments[i]) * lattice.spacing / kFrame);
            }
            EXPECT_LT(fastest, 20) << stiff << exact; // loose pieces fall for a second
        }
    }
}
