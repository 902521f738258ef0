// A pushing sphere touches the organ's surface, wherever it lies between the nodes, and ordinary palpation
// neither turns cells inside out nor leaves a dent.
#include "shaders/shared_constants.h"
#include "sim/cell_volumes.h"
#include "sim/cpu_solver.h"
#include "sim/node_depths.h"
#include "sim/solver.h"
#include "sim/tool_motion.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace serosa;

namespace {

sim::Lattice latticeOf(const sim::TriangleMesh& mesh, double spacing) {
    sim::LatticeRequest request;
    request.spacing = spacing;
    auto lattice = sim::buildLattice(mesh, request);
    EXPECT_TRUE(lattice.ok());
    return std::move(lattice).value();
}

sim::SolverSetup setupOf(const sim::Lattice& lattice) {
    sim::SolverSetup setup;
    setup.lattice = &lattice;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
    return setup;
}

} // namespace

TEST(NodeDepths, areDistancesBelowTheSurface) {
    const double radius = 0.02, h = 0.003;
    const sim::Lattice lattice = latticeOf(test::ballMesh(radius, 5), h);
    double outermost = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const double r = glm::length(lattice.toWorld(lattice.restPosition(node)));
        const double depth = (radius - r) / h;
        EXPECT_NEAR(lattice.restDepth(node), std::max(sim::contactDepth(depth), -2.0), 0.03) << node;
        outermost = std::min(outermost, lattice.restDepth(node));
    }
    EXPECT_LT(outermost, -0.8) << "some nodes lie well outside";
}

TEST(NodeDepths, ofFullCellsAreOnTheirFaces) {
    const sim::Lattice lattice = test::blockLattice(4, 4, 4);
    const std::int64_t face = lattice.nodeAt({2, 4, 2}), below = lattice.nodeAt({2, 3, 2}),
                       inner = lattice.nodeAt({2, 2, 2});
    ASSERT_GE(std::min({face, below, inner}), 0);
    EXPECT_NEAR(lattice.restDepth(std::size_t(face)), 0, 1e-12);
    EXPECT_NEAR(lattice.restDepth(std::size_t(below)), 0.8,
                1e-12); // of 1: the cell may be squeezed by a fifth
    EXPECT_NEAR(lattice.restDepth(std::size_t(inner)), 1, 1e-12);
}

// The top of the box lies at three heights within its cells; the probe must not touch before, nor slip past.
TEST(Contact, beginsAtTheSurface) {
    const double h = 0.003;
    for (const double height : {0.0310, 0.0319, 0.0328}) {
        SCOPED_TRACE(height);
        const sim::Lattice lattice =
            latticeOf(test::boxMesh({-0.015, -height / 2, -0.015}, {0.015, height / 2, 0.015}), h);
        // Above a node, so that the lowest point of the sphere meets one.
        const glm::dvec3 node = lattice.toWorld(glm::dvec3(0));
        for (const double gap : {0.05, -0.05}) { // spacings above the top
            sim::SolverSetup setup = setupOf(lattice);
            const glm::dvec3 centre(node.x, height / 2 + 0.02 + gap * h, node.z);
            setup.tools = {{"probe", sim::ToolMode::push, 0.02, {{0, centre}}}};
            const auto solver = sim::makeReferenceSolver(setup);
            solver->advance(1);
            const double push = -solver->takeToolImpulses()[0].y;
            if (gap > 0)
                EXPECT_EQ(push, 0);
            else
                EXPECT_GT(push, 0);
        }
    }
}

TEST(Contact, palpationTurnsNoCellInsideOutAndLeavesNoDent) {
    const double radius = 0.04, probe = 0.02;
    const sim::TriangleMesh ball = test::ballMesh(radius, 5);
    const sim::Lattice lattice = latticeOf(ball, 0.006);
    sim::SolverSetup setup = setupOf(lattice);
    setup.tissue.airDrag = 20;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        setup.fixed.push_back(lattice.toWorld(lattice.restPosition(node)).y < -0.5 * radius);
    // Askew to the grid; 2.5 spacings deep, held, and away.
    const glm::dvec3 outward = glm::normalize(glm::dvec3(0.3, 0.8, 0.5));
    const auto at = [&](double gap) { return outward * (radius + probe + gap); };
    const double deep = -0.015;
    setup.tools = {{"probe",
                    sim::ToolMode::push,
                    probe,
                    {{0, at(0.002)}, {0.3, at(deep)}, {0.4, at(deep)}, {0.5, at(0.02)}}}};
    const auto solver = sim::makeReferenceSolver(setup);
    solver->advance(int(0.4 / setup.timeStep));
    const std::vector<double> ratios = sim::cellVolumeRatios(lattice, solver->state());
    EXPECT_GT(*std::min_element(ratios.begin(), ratios.end()), 0.2);
    EXPECT_EQ(sim::invertedCells(lattice, solver->state()), 0u);
    solver->advance(int(1.0 / setup.timeStep));
    const sim::LatticeState after = solver->state();
    double dent = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        dent = std::max(dent, glm::length(after.positions[node] - lattice.restPosition(node)));
    EXPECT_LT(dent, 0.01);
}

// Relative to the tool no node moves further with contact than it would have without, however fast it crosses
// the sphere, and from whatever side: contact takes energy, and never gives any.
TEST(Contact, neverSpeedsANodeUpAgainstTheTool) {
    std::mt19937 random(4);
    const auto vector = [&random](double size) {
        const auto one = [&] { return size * (double(random()) / 2147483648.0 - 1); };
        const double x = one(), y = one(), z = one();
        return glm::dvec3(x, y, z);
    };
    int crossed = 0;
    for (int i = 0; i < 2000; ++i) {
        sim::ToolMotion tool;
        tool.mode = SRS_TOOL_PUSH;
        tool.shape.radius = 2;
        tool.from = vector(1);
        tool.to = tool.from + vector(0.5);
        const double depth = vector(1).x, reach = tool.shape.radius + depth;
        const glm::dvec3 x = tool.from + glm::normalize(vector(1)) * reach * 1.000001; // touching
        const glm::dvec3 free = tool.to + vector(0.9 * reach);
        const glm::dvec3 after = tool.apply(x, free, false, depth);
        const glm::dvec3 start = x - tool.from;
        EXPECT_LE(glm::length(after - tool.to - start), glm::length(free - tool.to - start) * (1 + 1e-9));
        EXPECT_GE(glm::length(after - tool.to), reach * (1 - 1e-9));
        crossed += glm::dot(free - tool.to, start) < 0; // to the other half of the sphere
    }
    EXPECT_GT(crossed, 500);
}

// A grasp lets go inside a pushing sphere, or a sphere begins inside of the organ: what lies there is not
// thrown out in one step.
TEST(Contact, whatLiesInsideComesOutSlowly) {
    sim::ToolMotion tool;
    tool.mode = SRS_TOOL_PUSH;
    tool.shape.radius = 3;
    glm::dvec3 x(0.5, 0, 0);
    int steps = 0;
    for (; glm::length(x) < 3 - 1e-9 && steps < 1000; ++steps) {
        const glm::dvec3 next = tool.apply(x, x, false, 0);
        EXPECT_LE(glm::length(next - x), SRS_EJECTION * (1 + 1e-9));
        x = next;
    }
    EXPECT_NEAR(steps, 2.5 / SRS_EJECTION, 1);

    // On all solvers alike.
    const sim::Lattice lattice = test::blockLattice(6, 6, 6);
    sim::SolverSetup setup = setupOf(lattice);
    setup.tissue.dampingTime = 0.002;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
    setup.tools = {{"probe", sim::ToolMode::push, 0.004, {{0, lattice.toWorld({0.3, 0.2, 0.1})}}}};
    const auto reference = sim::makeReferenceSolver(setup);
    const auto cpu = sim::makeCpuSolver(setup);
    reference->advance(300);
    cpu->advance(300);
    const sim::LatticeState a = reference->state(), b = cpu->state();
    double worst = 0, moved = 0, fastest = 0;
    for (std::size_t node = 0; node < a.positions.size(); ++node) {
        EXPECT_TRUE(std::isfinite(b.positions[node].x));
        worst = std::max(worst, glm::distance(a.positions[node], b.positions[node]));
        moved = std::max(moved, glm::distance(a.positions[node], lattice.restPosition(node)));
        fastest = std::max(fastest, glm::length(a.increments[node]));
    }
    EXPECT_LT(worst, 1e-3);
    EXPECT_GT(moved, 0.3);
    EXPECT_LT(fastest, 2 * SRS_EJECTION);
}

TEST(CellVolumes, areThoseOfAnAffineMap) {
    const sim::Lattice lattice = test::blockLattice(3, 2, 4);
    const glm::dmat3 map(glm::dvec3(1.2, 0.1, 0), glm::dvec3(-0.2, 0.9, 0.3), glm::dvec3(0.1, 0, 0.8));
    sim::LatticeState state = sim::restState(lattice);
    for (glm::dvec3& x : state.positions)
        x = map * x + glm::dvec3(3, -2, 1);
    for (const double ratio : sim::cellVolumeRatios(lattice, state))
        EXPECT_NEAR(ratio, glm::determinant(map), 1e-12);
    for (glm::dvec3& x : state.positions)
        x.y = -x.y;
    EXPECT_EQ(sim::invertedCells(lattice, state), lattice.cells.size());
}

TEST(StartState, fallsFromRestExactly) {
    const sim::Lattice lattice = test::blockLattice(2, 2, 2);
    sim::SolverSetup setup = setupOf(lattice);
    setup.gravity = {0, -9.81, 0};
    const auto solver = sim::makeReferenceSolver(setup);
    solver->setState(sim::startState(setup));
    solver->advance(200);
    const double time = 200 * setup.timeStep;
    const sim::LatticeState after = solver->state();
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        EXPECT_NEAR((after.positions[node] - lattice.restPosition(node)).y * lattice.spacing,
                    -0.5 * 9.81 * time * time, 1e-9 * time * time);
}
