// Cuts on the GPU against the CPU: the same decisions from the same positions, symmetric bits, equal pieces,
// undo to the first bytes, on both layouts.
#include "shaders/shared_constants.h"
#include "sim/cut_list.h"
#include "sim/pieces.h"
#include "tests/gl_fixture.h"
#include "tests/sim/cut_strokes.h"

#include <gtest/gtest.h>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::Stroke;

namespace {

class GlCut : public test::GlTest {
protected:
    static std::unique_ptr<sim::Solver> fragment(const sim::SolverSetup& setup, int layout = -1) {
        sim::FragmentOptions options;
        options.layout = layout;
        return sim::makeFragmentSolver(setup, options).value();
    }
};

} // namespace

TEST_F(GlCut, decidesAsTheCpuDoesOnTheSamePositions) {
    const Lattice lattice = test::hollowBall();
    sim::SolverSetup setup = test::plainSetup(lattice);
    setup.gravity = {0, -9.81, 0};
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(node.y <= 1);
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS}) {
        const auto solver = fragment(setup, layout);
        std::mt19937 random(31);
        std::size_t cut = 0;
        for (int i = 0; i < 120; ++i) {
            const LatticeState before = solver->state();
            std::vector<std::uint32_t> expected = test::connectionsOf(lattice, before);
            const Stroke stroke = test::randomStroke(lattice, random, 0.25);
            sim::cutConnections(lattice, before.positions, sim::toLattice(stroke, lattice), expected);
            ASSERT_TRUE(solver->cut(stroke).ok());
            const LatticeState after = solver->state();
            ASSERT_EQ(test::connectionsOf(lattice, after), expected) << "stroke " << i;
            ASSERT_EQ(test::unmatchedBits(lattice, expected), 0u);
            ASSERT_EQ(after.positions, before.positions);
            ASSERT_EQ(after.heldBy, before.heldBy);
            EXPECT_EQ(solver->pieces().value(), sim::pieceLabels(lattice, expected));
            cut = sim::springsCut(lattice, expected);
            if (i % 2 == 0)
                solver->advance(7);
        }
        EXPECT_GT(cut, 300u);
    }
}

TEST_F(GlCut, undoOfEveryStrokeReturnsTheFirstBytes) {
    const Lattice lattice = test::hollowBall();
    const auto solver = fragment(test::plainSetup(lattice));
    sim::CutList list;
    std::mt19937 random(32);
    std::vector<std::string> hashes;
    for (int i = 0; i < 20; ++i) {
        hashes.push_back(solver->state().hash());
        Stroke stroke = test::randomStroke(lattice, random, 0.4);
        ASSERT_TRUE(list.cut(*solver, 0, stroke).ok());
        stroke = test::randomStroke(lattice, random, 0.4);
        stroke.continues = true;
        ASSERT_TRUE(list.cut(*solver, 0, stroke).ok());
    }
    for (; !hashes.empty(); hashes.pop_back()) {
        ASSERT_TRUE(list.undo(*solver));
        EXPECT_EQ(solver->state().hash(), hashes.back());
    }
    EXPECT_FALSE(list.undo(*solver));
    EXPECT_TRUE(solver->state().connections.empty());
}

TEST_F(GlCut, continuesAsTheReferenceDoesAfterACut) {
    const Lattice beam = test::blockLattice(12, 3, 3);
    sim::SolverSetup setup = test::plainSetup(beam);
    setup.gravity = {0, -9.81, 0};
    for (const glm::ivec3& node : beam.nodes)
        setup.fixed.push_back(node.x == 0);
    const auto reference = sim::makeReferenceSolver(setup);
    const auto solver = fragment(setup);
    Stroke half = test::fullCut(beam, -2.5);
    for (std::size_t i = 0; i < 2; ++i)
        half.to[i].y = beam.toWorld({0, 0.2, 0}).y;
    for (sim::Solver* one : {reference.get(), solver.get()}) {
        one->advance(20);
        ASSERT_TRUE(one->cut(half).ok());
        one->advance(10);
        ASSERT_TRUE(one->cut(test::fullCut(beam, 1.5)).ok());
        one->advance(200);
    }
    const LatticeState a = reference->state(), b = solver->state();
    EXPECT_EQ(a.connections, b.connections);
    for (std::size_t node = 0; node < beam.nodeCount(); ++node)
        EXPECT_LT(glm::length(a.positions[node] - b.positions[node]), 1e-3) << node;
    EXPECT_EQ(sim::countPieces(solver->pieces().value()).pieces, 2u);
}

TEST_F(GlCut, severedHalfFallsFreely) {
    const Lattice beam = test::blockLattice(12, 3, 3);
    sim::SolverSetup setup = test::plainSetup(beam);
    setup.gravity = {0, -9.81, 0};
    for (const glm::ivec3& node : beam.nodes)
        setup.fixed.push_back(node.x == 0);
    const auto solver = fragment(setup);
    ASSERT_TRUE(solver->cut(test::fullCut(beam, 0.5)).ok());
    const int steps = 400;
    solver->advance(steps);
    const LatticeState after = solver->state();
    const double path = 9.81 * setup.timeStep * setup.timeStep / beam.spacing * steps * (steps + 1) / 2;
    for (std::size_t node = 0; node < beam.nodeCount(); ++node)
        if (beam.restPosition(node).x > 0.5) {
            const glm::dvec3 moved = after.positions[node] - beam.restPosition(node);
            EXPECT_LT(glm::length(moved - glm::dvec3(0, -path, 0)), 1e-5 * path) << node;
        }
}
