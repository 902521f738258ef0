// The CPU solver against the reference and against itself: threads, instruction sets, odd sizes.
#include "shaders/shared_constants.h"
#include "sim/cpu_solver.h"
#include "sim/packed_normal.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <hwy/targets.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

using namespace serosa;
using sim::CpuOptions;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

namespace {

/// A thin curved shell, partly filled, with fixed nodes, gravity, damping, drag, a probe and forceps.
struct Organ {
    Lattice lattice;
    SolverSetup setup;
    explicit Organ(double damping = 0.0005, int steps = 300) {
        std::vector<sim::LatticeCell> cells;
        std::mt19937 random(5);
        for (int z = 0; z < 15; ++z)
            for (int y = 0; y < 14; ++y)
                for (int x = 0; x < 40; ++x) {
                    const double bend = 3 * std::sin(0.16 * x);
                    const double r = glm::length((glm::dvec3(x, y - bend, z) - glm::dvec3(19.5, 5.5, 7)) /
                                                 glm::dvec3(19.6, 5, 6.5));
                    if (r < 1 && r > 0.75)
                        cells.push_back({{x, y, z}, std::uint8_t(60 + random() % 196)});
                }
        lattice = sim::latticeFromCells(cells, 0.003, {0.1, 1.6, -0.2});
        setup.lattice = &lattice;
        setup.gravity = {0, -9.81, 0};
        setup.tissue.airDrag = 2;
        setup.tissue.dampingTime = damping;
        setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(node.x < 3);
        const double t = setup.timeStep * steps;
        glm::dvec3 top(-1e9); // of the nodes near the fixed end, where the organ does not sag away
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            if (lattice.nodes[node].x > 5 && lattice.nodes[node].x < 10 &&
                lattice.restPosition(node).y > top.y)
                top = lattice.restPosition(node);
        top = lattice.toWorld(top);
        const glm::dvec3 end = lattice.toWorld(lattice.restPosition(lattice.nodeCount() / 2));
        setup.tools = {{"probe",
                        sim::ToolMode::push,
                        0.006,
                        {{0, top + glm::dvec3(0, 0.004, 0)},
                         {0.2 * t, top - glm::dvec3(0, 0.006, 0)}, // faster than it sags
                         {t, top - glm::dvec3(0, 0.012, 0)}}},
                       {"forceps",
                        sim::ToolMode::grasp,
                        0.007,
                        {{0.2 * t, end}, {0.9 * t, end + glm::dvec3(0.002, 0.006, 0)}}}};
    }
    Organ(const Organ&) = delete;
    Organ& operator=(const Organ&) = delete;
};

SolverSetup plainSetup(const Lattice& lattice, double damping = 0) {
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue.dampingTime = damping;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
    return setup;
}

/// Infinity where a number is none.
double largestDifference(const LatticeState& a, const LatticeState& b) {
    double worst = 0;
    for (std::size_t node = 0; node < a.positions.size(); ++node) {
        const double apart = glm::length(a.positions[node] - b.positions[node]);
        worst = std::isfinite(apart) ? std::max(worst, apart) : HUGE_VAL;
    }
    return worst;
}

std::string hashAfter(const SolverSetup& setup, int steps, const CpuOptions& options = {}) {
    const auto solver = sim::makeCpuSolver(setup, options);
    solver->advance(steps);
    return solver->state().hash();
}

/// Runs `test` once for every instruction set that this processor has and the kernel was built for.
template <class Test>
void forEveryTarget(const Test& test) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        SCOPED_TRACE(hwy::TargetName(target));
        EXPECT_STREQ(sim::cpuSolverTarget(), hwy::TargetName(target));
        test();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

} // namespace

// In parts of 20 steps from the reference's own state: which triangle a tool pushes can turn on the last bit,
// and whole runs part from there.
TEST(CpuSolver, followsTheReferenceOnAThinCurvedOrgan) {
    const Organ organ;
    constexpr int kParts = 15, kSteps = 20;
    const auto reference = sim::makeReferenceSolver(organ.setup);
    std::vector<LatticeState> expected{reference->state()};
    std::vector<std::vector<glm::dvec3>> impulses;
    glm::dvec3 sums[2] = {};
    for (int part = 0; part < kParts; ++part) {
        reference->advance(kSteps);
        expected.push_back(reference->state());
        impulses.push_back(reference->takeToolImpulses());
        for (std::size_t tool = 0; tool < 2; ++tool)
            sums[tool] += impulses.back()[tool];
    }
    EXPECT_GT(largestDifference(expected.back(), sim::restState(organ.lattice)), 0.5);
    ASSERT_GT(glm::length(sums[0]), 0);
    ASSERT_GT(glm::length(sums[1]), 0);
    forEveryTarget([&] {
        const auto solver = sim::makeCpuSolver(organ.setup);
        for (int part = 0; part < kParts; ++part) {
            solver->setState(expected[std::size_t(part)]);
            solver->advance(kSteps);
            const LatticeState got = solver->state();
            EXPECT_LT(largestDifference(got, expected[std::size_t(part) + 1]), 2e-4) << part;
            EXPECT_EQ(got.step, (part + 1) * kSteps);
            const std::vector<glm::dvec3> gotImpulses = solver->takeToolImpulses();
            for (std::size_t tool = 0; tool < 2; ++tool)
                EXPECT_LT(glm::length(gotImpulses[tool] - impulses[std::size_t(part)][tool]),
                          1e-3 * glm::length(sums[tool]))
                    << tool;
        }
    });
}

TEST(CpuSolver, holdsTheSameNodesAsTheReference) {
    const Organ organ(0.0005, 60);
    const auto reference = sim::makeReferenceSolver(organ.setup);
    const auto solver = sim::makeCpuSolver(organ.setup);
    std::size_t held = 0;
    for (const int steps : {12, 2, 20, 15, 10}) {
        reference->advance(steps);
        solver->advance(steps);
        EXPECT_EQ(solver->state().heldBy, reference->state().heldBy)
            << "after step " << reference->state().step;
        for (const std::uint32_t holder : solver->state().heldBy)
            held += holder > 0;
    }
    EXPECT_GT(held, 0u);
}

TEST(CpuSolver, oneSpringOneStepInAllDirections) {
    forEveryTarget([] {
        for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
            const Lattice cell = test::blockLattice(1, 1, 1);
            const SolverSetup setup = plainSetup(cell);
            std::size_t node = 0;
            while (cell.neighbour(node, d) < 0)
                ++node;
            const auto other = std::size_t(cell.neighbour(node, d));
            LatticeState state = sim::restState(cell);
            state.connections.assign(cell.nodeCount(), 0);
            state.connections[node] = 1u << d;
            state.connections[other] = 1u << (d ^ 1);
            const glm::dvec3 along = glm::normalize(glm::dvec3(sim::kNeighbourOffsets[std::size_t(d)]));
            const double stretch = 0.1 * (d < 6 ? 1 : std::sqrt(2.0));
            state.positions[other] += stretch * along;
            const auto solver = sim::makeCpuSolver(setup);
            solver->setState(state);
            solver->advance(1);
            const LatticeState after = solver->state();
            // The lone cell's share of the spring: k/4 on an edge, k/2 on a diagonal; of the mass: 1/8 a
            // corner.
            const double step = setup.timeStep * setup.timeStep *
                                setup.tissue.stiffnessOverMass(cell.spacing) * (d < 6 ? 0.25 : 0.5) * 8 *
                                stretch;
            EXPECT_LT(glm::length(after.positions[node] - cell.restPosition(node) - step * along), 1e-6) << d;
            EXPECT_LT(
                glm::length(after.positions[other] - cell.restPosition(other) - (stretch - step) * along),
                1e-6)
                << d;
            EXPECT_EQ(after.connections, state.connections) << "cuts are given back";
        }
    });
}

TEST(CpuSolver, freeFallFollowsTheParabola) {
    const Organ organ;
    SolverSetup setup = organ.setup;
    setup.tissue.airDrag = setup.tissue.dampingTime = 0;
    setup.fixed.clear();
    setup.tools.clear();
    LatticeState state = sim::restState(organ.lattice);
    const double dt = setup.timeStep, h = organ.lattice.spacing;
    for (glm::dvec3& u : state.increments)
        u = -0.5 * dt * dt / h * setup.gravity;
    const auto solver = sim::makeCpuSolver(setup);
    solver->setState(state);
    solver->advance(400);
    const LatticeState after = solver->state();
    double moved = 0, mass = 0;
    for (std::size_t node = 0; node < after.positions.size(); ++node) {
        moved += organ.lattice.massShare(node) * (after.positions[node] - organ.lattice.restPosition(node)).y;
        mass += organ.lattice.massShare(node);
    }
    const double path = 0.5 * 9.81 * (400 * dt) * (400 * dt);
    EXPECT_NEAR(-moved / mass * h / path, 1, 1e-5);
}

TEST(CpuSolver, keepsMomentum) {
    const Organ organ;
    for (const double damping : {0.0, 0.0005}) {
        SolverSetup setup = plainSetup(organ.lattice, damping);
        LatticeState state = sim::restState(organ.lattice);
        std::mt19937 random(3);
        for (glm::dvec3& u : state.increments)
            u = 0.01 * glm::dvec3(double(random()) / 2147483648.0 - 1, double(random()) / 2147483648.0 - 1,
                                  double(random()) / 2147483648.0 - 1);
        const auto sum = [&organ](const LatticeState& s, glm::dvec3& total) {
            double size = 0;
            for (std::size_t node = 0; node < s.increments.size(); ++node) {
                total += organ.lattice.massShare(node) * s.increments[node];
                size += organ.lattice.massShare(node) * glm::length(s.increments[node]);
            }
            return size;
        };
        const auto solver = sim::makeCpuSolver(setup);
        solver->setState(state);
        glm::dvec3 before(0), after(0);
        const double size = sum(solver->state(), before);
        solver->advance(1000);
        sum(solver->state(), after);
        EXPECT_LT(glm::length(after - before) / size, 1e-5) << "damping " << damping;
    }
}

TEST(CpuSolver, restHasNoForceAtAll) {
    const Organ organ;
    forEveryTarget([&] {
        const auto solver = sim::makeCpuSolver(plainSetup(organ.lattice, 0.0005));
        solver->advance(1000);
        const LatticeState after = solver->state(), rest = sim::restState(organ.lattice);
        EXPECT_EQ(after.positions, rest.positions);
        EXPECT_EQ(after.increments, rest.increments);
        const auto once = sim::makeCpuSolver(plainSetup(organ.lattice, 0.0005));
        once->advance(1);
        EXPECT_EQ(after.normals, once->state().normals);
    });
}

TEST(CpuSolver, sameBytesWithAnyNumberOfThreads) {
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 3);
    const Organ organ;
    const std::string one = hashAfter(organ.setup, 150, {1, false});
    for (const int threads : {0, 1, 2, 3})
        for (int again = 0; again < 2; ++again)
            EXPECT_EQ(hashAfter(organ.setup, 150, {threads, false}), one) << threads;
    // What tools gave is summed in one order too.
    const auto first = sim::makeCpuSolver(organ.setup, {1, false}),
               second = sim::makeCpuSolver(organ.setup, {3, false});
    first->advance(150);
    second->advance(150);
    EXPECT_EQ(first->takeToolImpulses(), second->takeToolImpulses());
}

TEST(CpuSolver, normalsOfTheLastStepAreThoseOfEveryStep) {
    const Organ organ;
    EXPECT_EQ(hashAfter(organ.setup, 40, {0, true}), hashAfter(organ.setup, 40, {0, false}));
    const auto inPieces = sim::makeCpuSolver(organ.setup);
    for (const int steps : {1, 7, 32})
        inPieces->advance(steps);
    EXPECT_EQ(inPieces->state().hash(), hashAfter(organ.setup, 40));
}

TEST(CpuSolver, packsNormalsToTheSameBitsAsPackNormal) {
    // At rest unit vectors are exact but for the rounding of sqrt(2), which this repeats in the kernel's
    // order; random springs are missing, so that sums point anywhere.
    const Organ organ;
    const Lattice& lattice = organ.lattice;
    std::mt19937 random(17);
    LatticeState state = sim::restState(lattice);
    state.connections = lattice.connections;
    for (std::uint32_t& bits : state.connections)
        bits &= std::uint32_t(random());
    forEveryTarget([&] {
        const auto solver = sim::makeCpuSolver(plainSetup(lattice));
        solver->setState(state);
        solver->advance(1);
        const LatticeState after = solver->state();
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
            glm::vec3 sum(0);
            for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
                if (d == 6)
                    sum *= 1.41421356f;
                if (state.connections[node] >> d & 1u)
                    sum -= glm::vec3(sim::kNeighbourOffsets[std::size_t(d)]);
            }
            ASSERT_EQ(after.normals[node], sim::packNormal(sum)) << node;
        }
    });
}

TEST(CpuSolver, everySizeAroundAVectorFollowsTheReference) {
    forEveryTarget([] {
        for (const int cells : {1, 2, 3, 6, 7, 8, 14, 15, 16, 17, 31, 33}) {
            const Lattice lattice = test::blockLattice(cells, 1, 2);
            SolverSetup setup = plainSetup(lattice, 0.0005);
            setup.gravity = {0.5, -9.81, 2};
            setup.fixed.assign(lattice.nodeCount(), false);
            setup.fixed[0] = true;
            const auto solver = sim::makeCpuSolver(setup), reference = sim::makeReferenceSolver(setup);
            solver->advance(100);
            reference->advance(100);
            EXPECT_LT(largestDifference(solver->state(), reference->state()), 1e-4) << cells;
            EXPECT_EQ(solver->state().positions[0], lattice.restPosition(0));
        }
    });
}

TEST(CpuSolver, gapsOfEveryWidthKeepPiecesApart) {
    // Two pieces in one row, `gap` cells apart, under a bridge over half of the gaps.
    forEveryTarget([] {
        for (int gap = 1; gap < 40; gap += gap < 20 ? 1 : 6) {
            std::vector<sim::LatticeCell> cells;
            for (const int x : {0, 1, 2 + gap, 3 + gap, 4 + gap})
                cells.push_back({{x, 0, 0}, std::uint8_t(100 + x)});
            for (int x = 0; gap % 2 && x < gap + 5; ++x)
                cells.push_back({{x, 1, 0}, 255});
            const Lattice lattice = sim::latticeFromCells(cells, 0.003, glm::dvec3(0));
            SolverSetup setup = plainSetup(lattice, 0.0005);
            LatticeState state = sim::restState(lattice);
            std::mt19937 random(std::uint32_t(gap) + 1);
            for (glm::dvec3& x : state.positions)
                x += 0.05 * glm::dvec3(double(random() % 100) / 50 - 1, double(random() % 100) / 50 - 1, 0.5);
            const auto solver = sim::makeCpuSolver(setup), reference = sim::makeReferenceSolver(setup);
            solver->setState(state);
            reference->setState(state);
            solver->advance(60);
            reference->advance(60);
            EXPECT_LT(largestDifference(solver->state(), reference->state()), 1e-4) << gap;
        }
    });
}

TEST(CpuSolver, continuesFromAStateWithTheSameBytes) {
    const Organ organ;
    const auto first = sim::makeCpuSolver(organ.setup), second = sim::makeCpuSolver(organ.setup);
    first->advance(70);
    second->setState(first->state());
    second->advance(50);
    EXPECT_EQ(second->state().hash(), hashAfter(organ.setup, 120));
}

TEST(CpuSolver, cutSpringsPullNoMoreAndComeBackWithAnUncutState) {
    const Lattice beam = test::blockLattice(20, 1, 1);
    SolverSetup setup = plainSetup(beam, 0.0005);
    setup.gravity = {0, -9.81, 0};
    setup.fixed.assign(beam.nodeCount(), false);
    for (std::size_t node = 0; node < beam.nodeCount(); ++node)
        setup.fixed[node] = beam.nodes[node].x == 0;
    LatticeState state = sim::restState(beam);
    state.connections = beam.connections;
    for (std::size_t node = 0; node < beam.nodeCount(); ++node)
        for (int d = 0; d < SRS_NEIGHBOURS; ++d)
            if (const std::int64_t other = beam.neighbour(node, d); other >= 0)
                if ((beam.nodes[node].x <= 10) != (beam.nodes[std::size_t(other)].x <= 10))
                    state.connections[node] &= ~(1u << d);
    const auto solver = sim::makeCpuSolver(setup);
    solver->setState(state);
    solver->advance(200);
    const LatticeState after = solver->state();
    EXPECT_EQ(after.connections, state.connections);
    const double steps = 200, path = 0.5 * 9.81 * steps * (steps + 1) * setup.timeStep * setup.timeStep /
                                     beam.spacing; // from rest, Verlet
    for (std::size_t node = 0; node < beam.nodeCount(); ++node) {
        const double fallen = beam.restPosition(node).y - after.positions[node].y;
        if (beam.nodes[node].x > 10) {
            EXPECT_NEAR(fallen / path, 1, 1e-4) << node;
        }
        if (beam.nodes[node].x < 4) {
            EXPECT_LT(fallen, 0.5 * path) << node << " hangs";
        }
    }
    solver->setState(sim::restState(beam));
    solver->advance(200);
    EXPECT_EQ(solver->state().hash(), hashAfter(setup, 200)) << "whole again";
}
