// Contact, friction and grasps on the GPU against the reference, shape by shape, on both solvers and layouts;
// the same bytes twice; cuts; and what holds without a reference: nothing ends inside, momentum is what
// colliders gave.
#include "shaders/shared_constants.h"
#include "sim/distance_field.h"
#include "sim/shape_distance.h"
#include "sim/solver.h"
#include "sim/tool_motion.h"
#include "tests/gl_fixture.h"
#include "tests/sim/cut_strokes.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

namespace {

class GlContact : public test::GlTest {};

constexpr double kSpacing = 0.003;

/// A partly filled ball, five spacings in radius, fixed below or free, and one collider.
struct Case {
    Lattice lattice;
    SolverSetup setup;
    explicit Case(bool fixed = true) {
        std::vector<sim::LatticeCell> cells;
        std::mt19937 random(5);
        for (int z = 0; z < 10; ++z)
            for (int y = 0; y < 9; ++y)
                for (int x = 0; x < 10; ++x)
                    if (glm::length(glm::dvec3(x, y, z) - glm::dvec3(4.5, 4, 4.5)) < 4.9)
                        cells.push_back({{x, y, z}, std::uint8_t(100 + random() % 156)});
        lattice = sim::latticeFromCells(cells, kSpacing, {0.1, 1.6, -0.2});
        setup.lattice = &lattice;
        setup.gravity = {0, -9.81, 0};
        setup.tissue.airDrag = 5;
        setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(fixed && node.y <= 1);
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;

    glm::dvec3 at(double x, double y, double z) const { return lattice.toWorld({x, y, z}); }

    /// Presses from above by `deep` spacings within 40 steps, aside and turning as it goes.
    sim::Tool& press(const sim::RigidShape& shape, double deep, double friction) {
        const double t = setup.timeStep;
        const glm::dquat from = glm::angleAxis(0.4, glm::normalize(glm::dvec3(1, 0.3, -0.2))),
                         to = glm::angleAxis(0.3, glm::normalize(glm::dvec3(0.2, 1, 0.4))) * from;
        sim::Tool tool;
        tool.name = "tool";
        tool.shape = shape;
        tool.radius = shape.radius;
        tool.friction = friction;
        // So far above that the shape just does not touch the top of the ball.
        double high = 5;
        const sim::RigidShape own = sim::scaledShape(shape, 1 / kSpacing);
        const auto gap = [&](double y) {
            double least = 1e9;
            for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
                least = std::min(least,
                                 sim::shapeDistance(own, glm::conjugate(from) * (lattice.restPosition(node) -
                                                                                 glm::dvec3(0.35, y, 0.2))) -
                                     lattice.restDepth(node));
            return least;
        };
        while (gap(high) < 0.05 && high < 30)
            high += 0.1;
        tool.keys = {{0, at(0.35, high, 0.2), from}, {40 * t, at(0.8, high - deep, 0.3), to}};
        setup.tools.push_back(tool);
        return setup.tools.back();
    }
};

sim::RigidShape shapeOf(sim::ShapeKind kind) {
    const double h = kSpacing;
    sim::RigidShape shape;
    shape.kind = kind;
    shape.radius = 0.7 * h;
    switch (kind) {
    case sim::ShapeKind::sphere:
        shape.radius = 2.2 * h;
        break;
    case sim::ShapeKind::capsule:
        shape.length = 8 * h;
        break;
    case sim::ShapeKind::box:
        shape.radius = 0.2 * h;
        shape.halfSize = glm::dvec3(1.7, 0.5, 2.4) * h;
        shape.middle = glm::dvec3(0.3, 0.2, 0) * h;
        break;
    case sim::ShapeKind::hook:
        shape.bend = 1.5 * h;
        shape.length = 6 * h;
        break;
    case sim::ShapeKind::halfSpace:
        shape.radius = 0;
        break;
    case sim::ShapeKind::mesh:
        shape.radius = 0;
        shape.field = std::make_shared<sim::DistanceField>(
            test::boxMesh(glm::dvec3(-1.9, -1.1, -2.3) * h, glm::dvec3(2.1, 1.2, 2.2) * h), 40);
        break;
    }
    return shape;
}

double largestDifference(const LatticeState& a, const LatticeState& b) {
    double worst = 0;
    for (std::size_t node = 0; node < a.positions.size(); ++node)
        worst = std::max(worst, glm::length(a.positions[node] - b.positions[node]));
    return worst;
}

/// Both solvers, on both layouts.
void forEachSolver(const SolverSetup& setup, const std::function<void(sim::Solver&)>& test) {
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS}) {
        sim::FragmentOptions fragment;
        sim::ComputeOptions compute;
        fragment.layout = compute.layout = layout;
        SCOPED_TRACE("layout " + std::to_string(layout));
        test(*sim::makeFragmentSolver(setup, fragment).value());
        test(*sim::makeComputeSolver(setup, compute).value());
    }
}

void followsReference(const SolverSetup& setup, int steps) {
    const auto reference = sim::makeReferenceSolver(setup);
    reference->advance(steps);
    const LatticeState expected = reference->state();
    const std::vector<sim::ToolLoad> loads = reference->takeLoads();
    EXPECT_GT(largestDifference(expected, sim::restState(*setup.lattice)), 0.2);
    double largest = 0;
    for (const sim::ToolLoad& load : loads)
        largest = std::max(largest, glm::length(load.impulse));
    EXPECT_GT(largest, 0);
    forEachSolver(setup, [&](sim::Solver& solver) {
        solver.advance(steps);
        const LatticeState got = solver.state();
        EXPECT_LT(largestDifference(got, expected), 1e-3) << solver.name();
        EXPECT_EQ(got.heldBy, expected.heldBy);
        const std::vector<sim::ToolLoad> gotLoads = solver.takeLoads();
        ASSERT_EQ(gotLoads.size(), loads.size());
        for (std::size_t i = 0; i < loads.size(); ++i) {
            EXPECT_LT(glm::distance(gotLoads[i].impulse, loads[i].impulse), 1e-3 * largest) << i;
            EXPECT_LT(glm::distance(gotLoads[i].angular, loads[i].angular), 1e-3 * largest * 5 * kSpacing)
                << i;
        }
        EXPECT_EQ(solver.takeLoads()[0].impulse, glm::dvec3(0)) << "taken once";
    });
}

/// Step by step from the reference's own states. Where a shape has edges, which point of a triangle is the
/// deepest and which triangle moves a node jumps as it slides, and runs that differ by a rounding part within
/// tens of steps, the cpu solver's from the reference's as well: whole runs say nothing there.
void takesTheSteps(const SolverSetup& setup, int steps) {
    const auto reference = sim::makeReferenceSolver(setup);
    std::vector<std::unique_ptr<sim::Solver>> solvers;
    solvers.push_back(sim::makeFragmentSolver(setup).value());
    solvers.push_back(sim::makeComputeSolver(setup).value());
    std::vector<sim::ToolLoad> sums(3); // the reference's, then the solvers'
    int apart = 0;
    for (int step = 0; step < steps; ++step) {
        LatticeState from = reference->state();
        for (std::vector<glm::dvec3>* values : {&from.positions, &from.increments})
            for (glm::dvec3& value : *values)
                value = glm::dvec3(glm::vec3(value));
        const auto take = [&](sim::Solver& solver, sim::ToolLoad& sum) {
            solver.setState(from);
            solver.advance(1);
            const sim::ToolLoad load = solver.takeLoads()[0];
            sum.impulse += load.impulse;
            sum.angular += load.angular;
        };
        take(*reference, sums[0]);
        const LatticeState expected = reference->state();
        for (std::size_t i = 0; i < solvers.size(); ++i) {
            take(*solvers[i], sums[i + 1]);
            apart += largestDifference(solvers[i]->state(), expected) > 2e-5;
        }
    }
    EXPECT_LE(apart, 2) << "of " << 2 * steps << " steps: rounding may choose otherwise once";
    const double size = glm::length(sums[0].impulse);
    EXPECT_GT(size, 0);
    EXPECT_GT(largestDifference(reference->state(), sim::restState(*setup.lattice)), 0.2);
    for (std::size_t i = 1; i < sums.size(); ++i) {
        EXPECT_LT(glm::distance(sums[i].impulse, sums[0].impulse), 1e-3 * size) << i;
        EXPECT_LT(glm::distance(sums[i].angular, sums[0].angular), 1e-3 * size * 5 * kSpacing) << i;
    }
}

} // namespace

TEST_F(GlContact, ofEveryShapeTakesTheReferencesSteps) {
    for (const sim::ShapeKind kind :
         {sim::ShapeKind::capsule, sim::ShapeKind::box, sim::ShapeKind::hook, sim::ShapeKind::mesh})
        for (const double friction : {0.0, 0.4}) {
            SCOPED_TRACE("shape " + std::to_string(int(kind)));
            Case c;
            c.press(shapeOf(kind), 1.5, friction);
            takesTheSteps(c.setup, 50);
        }
}

TEST_F(GlContact, ofSmoothShapesFollowsTheReference) {
    for (const sim::ShapeKind kind : {sim::ShapeKind::sphere, sim::ShapeKind::halfSpace})
        for (const double friction : {0.0, 0.4}) {
            SCOPED_TRACE("shape " + std::to_string(int(kind)));
            Case c;
            c.press(shapeOf(kind), 1.5, friction);
            followsReference(c.setup, 50);
        }
}

TEST_F(GlContact, ofAFallingBallOnBodiesFollowsTheReference) {
    Case c(false);
    sim::Body floor;
    floor.shape = shapeOf(sim::ShapeKind::halfSpace);
    floor.friction = 0.3;
    floor.pose.at = c.at(0, -4.55, 0);
    floor.pose.turn = glm::angleAxis(0.2, glm::dvec3(0, 0, 1));
    sim::Body post;
    post.shape = shapeOf(sim::ShapeKind::capsule);
    post.shape.length = 4 * kSpacing;
    post.pose = {c.at(2, -9.4, 1), glm::angleAxis(-std::numbers::pi / 2, glm::dvec3(1, 0, 0))};
    c.setup.bodies = {floor, post};
    c.setup.gravity = {0, -40, 0};
    followsReference(c.setup, 60);
}

TEST_F(GlContact, ofGraspsThatTurnAndSlipFollowsTheReference) {
    for (const bool slips : {false, true}) {
        Case c;
        const double t = c.setup.timeStep;
        sim::Tool& tool = c.press(shapeOf(sim::ShapeKind::box), 0, 0);
        tool.mode = sim::ToolMode::grasp;
        tool.keys = {{5 * t, c.at(0.2, 4, 0.1), tool.keys[0].turn},
                     {45 * t, c.at(1.0, 5.2, 0.4), tool.keys[1].turn},
                     {70 * t, c.at(1.2, 5.2, 0.4), tool.keys[1].turn}};
        if (slips)
            tool.gripForce = 0.02;
        sim::Tool probe = tool;
        probe.mode = sim::ToolMode::push;
        probe.shape = shapeOf(sim::ShapeKind::sphere);
        probe.radius = probe.shape.radius;
        probe.keys = {{0, c.at(-2, 7, 0)}, {60 * t, c.at(-2, 5.5, 0)}};
        c.setup.tools.push_back(probe);
        const auto reference = sim::makeReferenceSolver(c.setup);
        reference->advance(10);
        const auto holds = [](const LatticeState& state) {
            return std::count(state.heldBy.begin(), state.heldBy.end(), 1u);
        };
        const auto first = holds(reference->state());
        EXPECT_GE(first, 20);
        reference->advance(55);
        if (slips)
            EXPECT_LT(holds(reference->state()), first) << "some slip out";
        else
            EXPECT_EQ(holds(reference->state()), first);
        followsReference(c.setup, 65);
        followsReference(c.setup, 80); // and is let go
    }
}

TEST_F(GlContact, goesOnFromAStateInAGraspWithTheSameBytes) {
    Case c;
    const double t = c.setup.timeStep;
    sim::Tool& tool = c.press(shapeOf(sim::ShapeKind::box), 0, 0);
    tool.mode = sim::ToolMode::grasp;
    tool.gripForce = 0.02;
    tool.keys = {{5 * t, c.at(0.2, 4, 0.1)}, {45 * t, c.at(1.0, 5.5, 0.4)}};
    forEachSolver(c.setup, [&](sim::Solver& solver) {
        solver.advance(35);
        const std::string straight = solver.state().hash();
        solver.setState(sim::restState(c.lattice));
        solver.advance(17);
        const LatticeState half = solver.state();
        solver.setState(half);
        solver.advance(18);
        EXPECT_EQ(solver.state().hash(), straight) << solver.name();
    });
}

TEST_F(GlContact, repeatsByteForByte) {
    Case c;
    c.press(shapeOf(sim::ShapeKind::box), 1.2, 0.4);
    c.press(shapeOf(sim::ShapeKind::sphere), 1.0, 0.2);
    std::string hashes[2];
    std::vector<sim::ToolLoad> loads[2];
    for (int run = 0; run < 2; ++run)
        forEachSolver(c.setup, [&](sim::Solver& solver) {
            for (int frame = 0; frame < 5; ++frame)
                solver.advance(10);
            hashes[run] += solver.state().hash();
            for (const sim::ToolLoad& load : solver.takeLoads())
                loads[run].push_back(load);
        });
    EXPECT_EQ(hashes[0], hashes[1]);
    ASSERT_EQ(loads[0].size(), loads[1].size());
    for (std::size_t i = 0; i < loads[0].size(); ++i) {
        EXPECT_EQ(loads[0][i].impulse, loads[1][i].impulse);
        EXPECT_EQ(loads[0][i].angular, loads[1][i].angular);
    }
}

// No reference needed: a free organ without gravity or drag has just the momentum that tools gave it, and no
// node ends inside.
TEST_F(GlContact, givesTheMomentumThatItReportsAndLeavesNothingInside) {
    Case c(false);
    c.setup.gravity = {0, 0, 0};
    c.setup.tissue.airDrag = 0;
    c.press(shapeOf(sim::ShapeKind::sphere), 2.5, 0.3);
    const double unit = c.setup.tissue.nodeMass(kSpacing) * kSpacing / c.setup.timeStep;
    forEachSolver(c.setup, [&](sim::Solver& solver) {
        solver.advance(45);
        const LatticeState state = solver.state();
        const sim::ToolLoad load = solver.takeLoads()[0];
        glm::dvec3 momentum(0);
        for (std::size_t node = 0; node < c.lattice.nodeCount(); ++node)
            momentum += c.lattice.massShare(node) * state.increments[node] * unit;
        EXPECT_GT(glm::length(momentum), 0);
        EXPECT_LT(glm::distance(momentum, load.impulse), 1e-3 * glm::length(momentum)) << solver.name();
        const sim::ToolMotion tool = sim::toolMotions(c.setup, 44)[0];
        double least = 1;
        for (std::size_t node = 0; node < c.lattice.nodeCount(); ++node)
            least = std::min(least, sim::shapeDistance(tool.shape, tool.ownAtEnd(state.positions[node])) -
                                        c.lattice.restDepth(node));
        EXPECT_GT(least, -2e-5);
        EXPECT_LT(least, 0.05) << "it touches";
    });
}

TEST_F(GlContact, meetsTheFacesThatACutFreed) {
    // A block is cut through in the middle and its halves drift apart; a thin rod comes down in the gap,
    // where only freed faces are.
    const Lattice block = test::blockLattice(8, 4, 4);
    SolverSetup setup;
    setup.lattice = &block;
    setup.timeStep = sim::stableStep(block, setup.tissue, 1.0 / 60).timeStep;
    LatticeState apart = sim::restState(block);
    const sim::Stroke stroke = test::fullCut(block, 0.5);
    sim::Tool rod;
    rod.name = "rod";
    rod.shape.kind = sim::ShapeKind::capsule;
    rod.shape.length = 6 * block.spacing;
    rod.radius = rod.shape.radius = 0.35 * block.spacing;
    const double t = setup.timeStep;
    const auto at = [&](double x) { return block.toWorld({x, -1, 0.3}); };
    const glm::dquat up = glm::angleAxis(-std::numbers::pi / 2, glm::dvec3(1, 0, 0));
    rod.keys = {{0, at(0.5), up}, {40 * t, at(1.6), up}};
    setup.tools = {rod};
    const auto drive = [&](sim::Solver& solver) {
        EXPECT_TRUE(solver.cut(stroke).ok());
        LatticeState state = solver.state();
        for (std::size_t node = 0; node < block.nodeCount(); ++node)
            if (block.restPosition(node).x > 0.5)
                state.positions[node].x += 0.6;
        solver.setState(state);
        solver.advance(40);
    };
    const auto reference = sim::makeReferenceSolver(setup);
    drive(*reference);
    const LatticeState expected = reference->state();
    const glm::dvec3 impulse = reference->takeLoads()[0].impulse;
    EXPECT_GT(impulse.x, 0);
    forEachSolver(setup, [&](sim::Solver& solver) {
        drive(solver);
        EXPECT_LT(largestDifference(solver.state(), expected), 1e-3) << solver.name();
        EXPECT_LT(glm::distance(solver.takeLoads()[0].impulse, impulse), 1e-3 * glm::length(impulse));
    });
}
