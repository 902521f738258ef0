// Loads frame by frame: the ring gives exactly those of the frame two before, whatever the solver, and their
// sum is what the synchronous way gives.
#include "shaders/shared_constants.h"
#include "sim/cpu_solver.h"
#include "sim/solver.h"
#include "tests/gl_fixture.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

using namespace serosa;

namespace {

class GlLoads : public test::GlTest {
protected:
    GlLoads() {
        setup.lattice = &lattice;
        setup.tissue.airDrag = 5;
        setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(node.y == 0);
        sim::Tool probe;
        probe.name = "probe";
        probe.radius = 0.006;
        const double t = setup.timeStep;
        const auto at = [this](double y) { return lattice.toWorld({0.3, y, -0.2}); };
        probe.keys = {{0, at(4.6)}, {60 * t, at(3.4)}, {100 * t, at(6)}};
        setup.tools = {probe};
        sim::Body wall;
        wall.name = "wall";
        wall.shape.kind = sim::ShapeKind::box;
        wall.shape.radius = 0;
        wall.shape.halfSize = glm::dvec3(0.001, 0.02, 0.02);
        wall.pose.at = lattice.toWorld({3.35, 0, 0});
        setup.bodies = {wall};
    }

    std::vector<std::unique_ptr<sim::Solver>> solvers() {
        std::vector<std::unique_ptr<sim::Solver>> all;
        all.push_back(sim::makeReferenceSolver(setup));
        all.push_back(sim::makeCpuSolver(setup));
        all.push_back(sim::makeFragmentSolver(setup).value());
        all.push_back(sim::makeComputeSolver(setup).value());
        return all;
    }

    sim::Lattice lattice = test::blockLattice(6, 5, 6);
    sim::SolverSetup setup;
};

bool same(const std::vector<sim::ToolLoad>& a, const std::vector<sim::ToolLoad>& b) {
    if (a.size() != b.size())
        return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i].impulse != b[i].impulse || a[i].angular != b[i].angular)
            return false;
    return true;
}

} // namespace

TEST_F(GlLoads, comeTwoFramesLaterAndThenExactly) {
    constexpr int kFrames = 12, kSteps = 9;
    for (auto& solver : solvers()) {
        SCOPED_TRACE(solver->name());
        std::vector<std::vector<sim::ToolLoad>> synchronous;
        for (int frame = 0; frame < kFrames; ++frame) {
            solver->advance(kSteps);
            synchronous.push_back(solver->takeLoads());
            EXPECT_EQ(synchronous.back().size(), 2u);
        }
        EXPECT_NE(synchronous[4][0].impulse, synchronous[5][0].impulse) << "frames can be told apart";
        EXPECT_GT(glm::length(synchronous[5][1].impulse), 0) << "the wall is touched";
        solver->setState(sim::restState(lattice));
        for (int frame = 0; frame < kFrames; ++frame) {
            solver->advance(kSteps);
            solver->endFrame();
            const auto loads = solver->frameLoads();
            ASSERT_EQ(loads.has_value(), frame >= 2) << frame;
            if (loads) {
                EXPECT_TRUE(same(*loads, synchronous[std::size_t(frame - 2)])) << frame;
            }
        }
        const auto last = solver->flushFrames();
        ASSERT_EQ(last.size(), 2u);
        EXPECT_TRUE(same(last[0], synchronous[kFrames - 2]));
        EXPECT_TRUE(same(last[1], synchronous[kFrames - 1]));
        EXPECT_TRUE(solver->flushFrames().empty());
        EXPECT_EQ(solver->takeLoads()[0].impulse, glm::dvec3(0)) << "the frames took all";
    }
}

TEST_F(GlLoads, ofSolversAgree) {
    auto all = solvers();
    std::vector<std::vector<sim::ToolLoad>> loads;
    for (auto& solver : all) {
        solver->advance(70);
        loads.push_back(solver->takeLoads());
    }
    for (std::size_t i = 1; i < loads.size(); ++i)
        for (std::size_t c = 0; c < 2; ++c) {
            const sim::ToolLoad &expected = loads[0][c], &got = loads[i][c];
            EXPECT_GT(glm::length(expected.impulse), 0);
            EXPECT_LT(glm::distance(got.impulse, expected.impulse), 1e-3 * glm::length(expected.impulse));
            EXPECT_LT(glm::distance(got.angular, expected.angular),
                      1e-3 * glm::length(expected.impulse) * 6 * lattice.spacing);
        }
}

// Fixed point keeps what a thousand small steps give: the momentum of a free block that a probe pushes.
TEST_F(GlLoads, addUpToTheMomentumOfAFreeOrgan) {
    setup.fixed.clear();
    setup.bodies.clear();
    setup.tissue.airDrag = 0;
    setup.tools[0].keys[1].time = 1000 * setup.timeStep;
    setup.tools[0].keys[2].time = 1001 * setup.timeStep;
    const auto solver = sim::makeComputeSolver(setup).value();
    solver->advance(1000);
    const sim::LatticeState state = solver->state();
    glm::dvec3 momentum(0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        momentum += lattice.massShare(node) * state.increments[node];
    momentum *= setup.tissue.nodeMass(lattice.spacing) * lattice.spacing / setup.timeStep;
    const glm::dvec3 impulse = solver->takeLoads()[0].impulse;
    EXPECT_LT(glm::distance(impulse, momentum), 1e-3 * glm::length(momentum));
}
