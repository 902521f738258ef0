// The oracle itself: contact, grasp, damping, drag, energies, time step; against closed forms.
#include "sim/packed_normal.h"
#include "sim/solver.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

namespace {

SolverSetup setupOf(const Lattice& lattice) {
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue.dampingTime = 0;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
    return setup;
}

} // namespace

TEST(ReferenceSolver, energyOfAnUndampedBodyStays) {
    const Lattice lattice = test::blockLattice(4, 4, 4);
    SolverSetup setup = setupOf(lattice);
    setup.timeStep /= 32; // the increment is the velocity half a step ago: the error falls with the step
    const auto solver = sim::makeReferenceSolver(setup);
    LatticeState state = sim::restState(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        state.positions[node].x *= 1.02;
    solver->setState(state);
    const double start = sim::energies(setup, state).elastic;
    double kineticSeen = 0;
    for (int i = 0; i < 200; ++i) {
        solver->advance(20);
        const sim::Energies now = sim::energies(setup, solver->state());
        EXPECT_NEAR((now.kinetic + now.elastic) / start, 1, 0.01) << i;
        kineticSeen = std::max(kineticSeen, now.kinetic / start);
    }
    EXPECT_GT(kineticSeen, 0.3);
}

TEST(ReferenceSolver, dampingTakesEnergyAndKeepsMomentum) {
    const Lattice lattice = test::blockLattice(3, 3, 3);
    SolverSetup setup = setupOf(lattice);
    setup.tissue.dampingTime = 0.002;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
    const auto solver = sim::makeReferenceSolver(setup);
    LatticeState state = sim::restState(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        state.positions[node].y *= 1.05;
        state.increments[node] = {0.01, 0, 0}; // flies along x
    }
    solver->setState(state);
    const double start = sim::energies(setup, state).elastic;
    solver->advance(3000);
    const sim::Energies end = sim::energies(setup, solver->state());
    EXPECT_LT(end.elastic, 1e-6 * start);
    for (const glm::dvec3& u : solver->state().increments)
        EXPECT_NEAR(glm::length(u - glm::dvec3(0.01, 0, 0)), 0,
                    1e-6); // springs' damping does not brake flight
}

TEST(ReferenceSolver, airDragBrakesFlightExponentially) {
    const Lattice lattice = test::blockLattice(2, 2, 2);
    SolverSetup setup = setupOf(lattice);
    setup.tissue.airDrag = 3;
    const auto solver = sim::makeReferenceSolver(setup);
    LatticeState state = sim::restState(lattice);
    for (glm::dvec3& u : state.increments)
        u = {0, 0.02, 0};
    solver->setState(state);
    solver->advance(200);
    EXPECT_NEAR(solver->state().increments[0].y, 0.02 * std::pow(1 - 3 * setup.timeStep, 200), 1e-12);
}

TEST(ReferenceSolver, fixedNodesStay) {
    const Lattice lattice = test::blockLattice(3, 3, 3);
    SolverSetup setup = setupOf(lattice);
    setup.gravity = {0, -9.81, 0};
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(node.y == 3);
    const auto solver = sim::makeReferenceSolver(setup);
    solver->advance(50);
    const LatticeState state = solver->state();
    EXPECT_EQ(state.step, 50);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        EXPECT_EQ(state.positions[node] == lattice.restPosition(node), setup.fixed[node]) << node;
}

TEST(ReferenceSolver, pushLeavesNoNodeInsideAndAccountsForTheMomentum) {
    const Lattice lattice = test::blockLattice(6, 6, 6);
    SolverSetup setup = setupOf(lattice);
    const double end = 100 * setup.timeStep;
    const glm::dvec3 top = lattice.toWorld(glm::dvec3(0, 3, 0));
    setup.tools = {{"probe",
                    sim::ToolMode::push,
                    0.004,
                    {{0, top + glm::dvec3(0, 0.006, 0)}, {end, top + glm::dvec3(0, 0.001, 0)}}}};
    const auto solver = sim::makeReferenceSolver(setup);
    double closest = 1e9;
    for (int step = 1; step <= 100; ++step) {
        solver->advance(1);
        const LatticeState now = solver->state();
        const glm::dvec3 at = lattice.toLattice(setup.tools[0].centreAt(end * step / 100));
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            closest = std::min(closest, (glm::length(now.positions[node] - at) - lattice.restDepth(node)) *
                                            lattice.spacing);
    }
    const LatticeState state = solver->state();
    glm::dvec3 momentum(0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        momentum += lattice.massShare(node) * setup.tissue.nodeMass(lattice.spacing) *
                    state.increments[node] * (lattice.spacing / setup.timeStep);
    }
    EXPECT_NEAR(closest, 0.004, 1e-9); // pressed, and each node by its depth out of the sphere
    const glm::dvec3 impulse = solver->takeToolImpulses()[0];
    EXPECT_LT(impulse.y, 0);
    EXPECT_NEAR(glm::length(impulse - momentum) / glm::length(momentum), 0, 1e-9);
    EXPECT_EQ(solver->takeToolImpulses()[0], glm::dvec3(0)) << "taken";
}

TEST(ReferenceSolver, graspCarriesWhatItTouchedAndLetsGo) {
    const Lattice lattice = test::blockLattice(6, 2, 2);
    SolverSetup setup = setupOf(lattice);
    const double t1 = 10 * setup.timeStep, t2 = 60 * setup.timeStep;
    const glm::dvec3 corner = lattice.toWorld(lattice.restPosition(0));
    setup.tools = {
        {"forceps", sim::ToolMode::grasp, 0.0035, {{t1, corner}, {t2, corner - glm::dvec3(0.002, 0, 0)}}}};
    const auto solver = sim::makeReferenceSolver(setup);
    solver->advance(10);
    EXPECT_EQ(solver->state().heldBy[0], 0u);
    solver->advance(1);
    std::size_t held = 0;
    for (const std::uint32_t holder : solver->state().heldBy)
        held += holder == 1;
    EXPECT_EQ(held, 4u); // the corner and its three neighbours at h = 3 mm; diagonals are at 4.2 mm
    solver->advance(48);
    const double share = 49.0 / 50;
    EXPECT_NEAR(solver->state().positions[0].x, lattice.restPosition(0).x - share * 0.002 / 0.003, 1e-9);
    solver->advance(2);
    EXPECT_EQ(solver->state().heldBy[0], 0u);
}

TEST(StableStep, loneCellHasTwentyTimesTheRate) {
    const sim::Tissue tissue;
    const Lattice cell = test::blockLattice(1, 1, 1);
    EXPECT_NEAR(sim::stableStep(cell, tissue, 1).stiffestRate2 / tissue.stiffnessOverMass(cell.spacing), 20,
                1e-9);
}

TEST(StableStep, rateIsTheDenseEigenvalue) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 6; ++trial) {
        std::vector<sim::LatticeCell> cells;
        for (int i = 0; i < 27; ++i)
            if (i == 0 || random() % 3)
                cells.push_back(
                    {{i % 3, i / 3 % 3, i / 9}, std::uint8_t(1 + random() % (trial < 3 ? 255 : 8))});
        const Lattice lattice = sim::latticeFromCells(cells, 0.003, glm::dvec3(0));
        const auto size = Eigen::Index(3 * lattice.nodeCount());
        Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size), mass = stiffness;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
            mass.diagonal().segment<3>(Eigen::Index(3 * node)).setConstant(lattice.massShare(node));
            for (int d = 0; d < 18; ++d)
                if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                    const glm::dvec3 n = glm::normalize(glm::dvec3(sim::kNeighbourOffsets[std::size_t(d)]));
                    const Eigen::Matrix3d block = lattice.springWeight(node, d) *
                                                  Eigen::Vector3d(n.x, n.y, n.z) *
                                                  Eigen::RowVector3d(n.x, n.y, n.z);
                    stiffness.block<3, 3>(Eigen::Index(3 * node), Eigen::Index(3 * node)) += block;
                    stiffness.block<3, 3>(Eigen::Index(3 * node), Eigen::Index(3 * other)) -= block;
                }
        }
        const double exact = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, mass)
                                 .eigenvalues()
                                 .maxCoeff();
        const sim::Tissue tissue;
        const double share =
            sim::stableStep(lattice, tissue, 1).stiffestRate2 / tissue.stiffnessOverMass(0.003);
        EXPECT_GE(share, std::max(12.0, exact * 0.9999));
        EXPECT_LE(share, std::max(12.0, exact * 1.021));
        EXPECT_LE(exact, 20 + 1e-9) << "no assembly of cells exceeds the lone cell";
    }
}

TEST(StableStep, fillsTheFrameWithWholeSteps) {
    const Lattice lattice = test::blockLattice(5, 5, 5);
    sim::Tissue tissue;
    tissue.dampingTime = 0;
    const sim::StableStep step = sim::stableStep(lattice, tissue, 1.0 / 60);
    EXPECT_DOUBLE_EQ(step.timeStep * step.stepsPerFrame, 1.0 / 60);
    EXPECT_LE(step.timeStep, step.margin * step.bound);
    EXPECT_GT(step.timeStep,
              step.margin * step.bound * (step.stepsPerFrame - 1) / step.stepsPerFrame * 0.999);
    EXPECT_NEAR(step.bound, 2 / std::sqrt(step.stiffestRate2), 1e-12);
    tissue.dampingTime = 0.001;
    EXPECT_LT(sim::stableStep(lattice, tissue, 1.0 / 60).bound, step.bound);
}

TEST(StableStep, beyondTheBoundItBlowsUpAndBelowItDoesNot) {
    const Lattice lattice = test::blockLattice(4, 4, 4);
    for (const double damping : {0.0, 0.001}) {
        SolverSetup setup = setupOf(lattice);
        setup.tissue.dampingTime = damping;
        const double bound = sim::stableStep(lattice, setup.tissue, 1).bound;
        for (const double share : {0.7, 1.05}) {
            setup.timeStep = share * bound;
            const auto solver = sim::makeReferenceSolver(setup);
            LatticeState state = sim::restState(lattice);
            for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
                state.positions[node].x += 1e-6 * double(node * 7919 % 101);
            solver->setState(state);
            solver->advance(2000);
            double moved = 0;
            for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
                const double distance =
                    glm::length(solver->state().positions[node] - lattice.restPosition(node));
                moved = std::isfinite(distance) ? std::max(moved, distance) : 1e30;
            }
            if (share < 1)
                EXPECT_LT(moved, 1e-3) << "damping " << damping;
            else
                EXPECT_GT(moved, 0.01) << "damping " << damping;
        }
    }
}

TEST(LatticeState, hashTellsStatesApart) {
    const Lattice lattice = test::blockLattice(2, 2, 2);
    LatticeState state = sim::restState(lattice), other = state;
    EXPECT_EQ(state.hash(), other.hash());
    other.positions[3].y += 1e-5;
    EXPECT_NE(state.hash(), other.hash());
    other = state;
    other.heldBy[0] = 1;
    EXPECT_NE(state.hash(), other.hash());
}

TEST(Tissue, springConstantGivesYoungsModulus) {
    sim::Tissue tissue; // design: 5 kPa, 1000 kg/m3, h = 3 mm gives k = 6 N/m, m = 27 mg
    EXPECT_NEAR(tissue.springConstant(0.003), 6, 1e-12);
    EXPECT_NEAR(tissue.nodeMass(0.003), 27e-6, 1e-15);
}
