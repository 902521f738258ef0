// Cuts through the CPU solver: symmetric bits, pieces, momentum, free fall after a full cut, undo and replay.
#include "sim/cut_list.h"
#include "sim/pieces.h"
#include "tests/sim/cut_strokes.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <set>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::Stroke;

namespace {

glm::dvec3 momentum(const Lattice& lattice, const LatticeState& state) {
    glm::dvec3 sum(0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        sum += lattice.massShare(node) * state.increments[node];
    return sum;
}

/// Springs that were kept though their ends lie on different sides of a plane across x, or on it.
std::size_t keptAcross(const Lattice& lattice, const LatticeState& state, double x) {
    std::size_t kept = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; ++d)
            if ((test::connectionsOf(lattice, state)[node] >> d) & 1u) {
                const auto other = std::size_t(lattice.neighbour(node, d));
                kept += (state.positions[node].x <= x) && (state.positions[other].x >= x);
            }
    return kept;
}

} // namespace

TEST(Cut, clearsBitsAtBothEnds) {
    const Lattice lattice = test::hollowBall();
    const auto solver = sim::makeReferenceSolver(test::plainSetup(lattice));
    std::mt19937 random(21);
    std::size_t before = 0;
    for (int i = 0; i < 60; ++i) {
        ASSERT_TRUE(solver->cut(test::randomStroke(lattice, random, 0.3)).ok());
        const LatticeState state = solver->state();
        const auto& bits = test::connectionsOf(lattice, state);
        EXPECT_EQ(test::unmatchedBits(lattice, bits), 0u);
        const std::size_t cut = sim::springsCut(lattice, bits);
        EXPECT_GE(cut, before);
        before = cut;
    }
    EXPECT_GT(before, 200u);
}

TEST(Cut, fullCutLeavesTwoPiecesThatPlanesSeparate) {
    const Lattice beam = test::blockLattice(12, 4, 4);
    for (const double x : {0.0, 0.5, 0.25, -1.0}) { // lattice planes and between
        const auto solver = sim::makeReferenceSolver(test::plainSetup(beam));
        ASSERT_TRUE(solver->cut(test::fullCut(beam, x)).ok());
        const LatticeState state = solver->state();
        EXPECT_EQ(keptAcross(beam, state, x), 0u) << x;
        const sim::PieceCount count = sim::countPieces(solver->pieces().value());
        EXPECT_EQ(count.pieces, 2u) << x;
        // A blade exactly in a plane of nodes touches all springs of its 25 nodes: ties count as crossed.
        EXPECT_EQ(count.loose, x == std::floor(x) ? 25u : 0u) << x;
    }
}

TEST(Cut, inALatticePlaneSparesWhatItDoesNotReach) {
    // A blade in the plane y = 0 that ends at x = 0.5: nodes of that plane beyond keep their springs.
    const Lattice block = test::blockLattice(8, 4, 4);
    const auto solver = sim::makeReferenceSolver(test::plainSetup(block));
    Stroke stroke;
    stroke.from = {block.toWorld({-9, 0, -9}), block.toWorld({-9, 0, 9})};
    stroke.to = {block.toWorld({0.5, 0, -9}), block.toWorld({0.5, 0, 9})};
    ASSERT_TRUE(solver->cut(stroke).ok());
    const LatticeState state = solver->state();
    const auto& bits = test::connectionsOf(block, state);
    for (std::size_t node = 0; node < block.nodeCount(); ++node) {
        const glm::dvec3 at = block.restPosition(node);
        const std::uint32_t gone = block.connections[node] & ~bits[node];
        if (at.y == 0 && at.x <= 0) {
            EXPECT_EQ(bits[node], 0u) << node;
        } else if (at.x > 1) {
            EXPECT_EQ(gone, 0u) << node;
        }
    }
    EXPECT_EQ(sim::countPieces(solver->pieces().value()).pieces, 1u);
}

TEST(Cut, keepsMomentum) {
    const Lattice lattice = test::hollowBall();
    const sim::SolverSetup setup = test::plainSetup(lattice);
    const auto solver = sim::makeReferenceSolver(setup);
    std::mt19937 random(22);
    LatticeState state = sim::restState(lattice);
    for (glm::dvec3& u : state.increments)
        u = 1e-3 *
            glm::dvec3(test::number(random, 0, 1), test::number(random, -1, 1), test::number(random, -1, 1));
    solver->setState(state);
    const glm::dvec3 before = momentum(lattice, state);
    for (int i = 0; i < 30; ++i) {
        ASSERT_TRUE(solver->cut(test::randomStroke(lattice, random, 0.6)).ok());
        solver->advance(10);
    }
    const LatticeState after = solver->state();
    EXPECT_GT(sim::springsCut(lattice, test::connectionsOf(lattice, after)), 100u);
    EXPECT_LT(glm::length(momentum(lattice, after) - before), 1e-11 * glm::length(before));
}

TEST(Cut, severedHalfFallsFreely) {
    const Lattice beam = test::blockLattice(12, 3, 3);
    sim::SolverSetup setup = test::plainSetup(beam);
    setup.gravity = {0, -9.81, 0};
    for (const glm::ivec3& node : beam.nodes)
        setup.fixed.push_back(node.x == 0);
    const auto solver = sim::makeReferenceSolver(setup);
    ASSERT_TRUE(solver->cut(test::fullCut(beam, 0.5)).ok());
    const int steps = 400;
    solver->advance(steps);
    const LatticeState after = solver->state();
    // Verlet: n steps of g dt^2, the first from rest, fall by n (n + 1) / 2 of them.
    const double path = 9.81 * setup.timeStep * setup.timeStep / beam.spacing * steps * (steps + 1) / 2;
    EXPECT_GT(path, 5);
    for (std::size_t node = 0; node < beam.nodeCount(); ++node)
        if (beam.restPosition(node).x > 0.5) {
            const glm::dvec3 moved = after.positions[node] - beam.restPosition(node);
            EXPECT_LT(glm::length(moved - glm::dvec3(0, -path, 0)), 1e-5 * path) << node;
        }
}

TEST(Cut, partialCutGapesUnderTension) {
    const Lattice bar = test::blockLattice(8, 6, 2);
    sim::SolverSetup setup = test::plainSetup(bar);
    for (const glm::ivec3& node : bar.nodes)
        setup.fixed.push_back(node.x == 0 || node.x == 8);
    const auto gap = [&](bool cut) {
        const auto solver = sim::makeReferenceSolver(setup);
        LatticeState state = sim::restState(bar);
        for (glm::dvec3& x : state.positions)
            x.x *= 1.1;
        solver->setState(state);
        if (cut) {
            Stroke stroke = test::fullCut(bar, 0.55);
            for (std::size_t i = 0; i < 2; ++i)
                stroke.to[i].y = bar.toWorld({0, 0.5, 0}).y; // from the top to the middle
            EXPECT_TRUE(solver->cut(stroke).ok());
        }
        solver->advance(2000);
        const LatticeState after = solver->state();
        double width = 0;
        for (std::size_t node = 0; node < bar.nodeCount(); ++node)
            if (bar.restPosition(node) == glm::dvec3(0, 3, 0))
                width = after.positions[std::size_t(bar.neighbour(0, 0) >= 0 ? node + 1 : node)].x -
                        after.positions[node].x;
        return width;
    };
    EXPECT_LT(gap(false), 1.2);
    EXPECT_GT(gap(true), 1.5);
}

TEST(Cut, undoOfEveryStrokeReturnsTheFirstBytes) {
    const Lattice lattice = test::hollowBall();
    const auto solver = sim::makeReferenceSolver(test::plainSetup(lattice));
    const std::string first = solver->state().hash();
    sim::CutList list;
    std::mt19937 random(23);
    std::vector<std::string> hashes;
    for (int i = 0; i < 25; ++i) {
        hashes.push_back(solver->state().hash());
        ASSERT_TRUE(list.cut(*solver, 0, test::randomStroke(lattice, random, 0.4)).ok());
        Stroke more = test::randomStroke(lattice, random, 0.4);
        more.continues = true;
        if (i % 3 == 0) {
            ASSERT_TRUE(list.cut(*solver, 0, more).ok());
        }
    }
    EXPECT_EQ(list.strokes(), 25u);
    EXPECT_NE(solver->state().hash(), first);
    for (; !hashes.empty(); hashes.pop_back()) {
        ASSERT_TRUE(list.undo(*solver));
        EXPECT_EQ(solver->state().hash(), hashes.back());
    }
    EXPECT_FALSE(list.undo(*solver));
    EXPECT_EQ(solver->state().hash(), first);
    EXPECT_TRUE(solver->state().connections.empty());
}

TEST(Cut, replayGivesTheSameBytes) {
    const Lattice lattice = test::hollowBall(7);
    sim::SolverSetup setup = test::plainSetup(lattice);
    setup.gravity = {0, -9.81, 0};
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(node.y <= 1);
    const auto solver = sim::makeReferenceSolver(setup);
    sim::CutList list;
    std::mt19937 random(24);
    for (int i = 0; i < 6; ++i) {
        solver->advance(20);
        ASSERT_TRUE(list.cut(*solver, 20 * (i + 1), test::randomStroke(lattice, random, 0.4)).ok());
    }
    solver->advance(30);
    const auto again = sim::makeReferenceSolver(setup);
    ASSERT_TRUE(list.replay(*again, 150).ok());
    EXPECT_EQ(again->state().hash(), solver->state().hash());
    EXPECT_EQ(again->state().step, 150);
}

TEST(Cut, cauterizingAndTearing) {
    const Lattice block = test::blockLattice(6, 6, 6);
    const auto solver = sim::makeReferenceSolver(test::plainSetup(block));
    Stroke ball;
    ball.kind = sim::StrokeKind::cauterize;
    ball.from[0] = block.toWorld({0, 0, 0});
    ball.radius = 0.4 * block.spacing;
    ASSERT_TRUE(solver->cut(ball).ok());
    // Only springs of the middle node touch the ball: 18, and its neighbours stay joined.
    LatticeState state = solver->state();
    EXPECT_EQ(sim::springsCut(block, test::connectionsOf(block, state)), 18u);
    sim::PieceCount count = sim::countPieces(solver->pieces().value());
    EXPECT_EQ(count.pieces, 1u);
    EXPECT_EQ(count.loose, 1u);

    ASSERT_TRUE(solver->undoCut());
    state = solver->state();
    for (std::size_t node = 0; node < block.nodeCount(); ++node)
        if (state.positions[node].x > 0.5)
            state.positions[node].x += 0.8;
    solver->setState(state);
    Stroke tear;
    tear.kind = sim::StrokeKind::tear;
    tear.strain = 0.3; // axis springs have 1.8, diagonals sqrt(1.8^2 + 1) / sqrt(2) = 1.46
    ASSERT_TRUE(solver->cut(tear).ok());
    EXPECT_EQ(sim::countPieces(solver->pieces().value()).pieces, 2u);
    EXPECT_EQ(test::unmatchedBits(block, solver->state().connections), 0u);
}

TEST(Cut, thinRemainsStayFinite) {
    const Lattice lattice = test::hollowBall();
    sim::SolverSetup setup = test::plainSetup(lattice);
    setup.gravity = {0, -9.81, 0};
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(node.y <= 1);
    const auto solver = sim::makeReferenceSolver(setup);
    std::mt19937 random(25);
    for (int i = 0; i < 40; ++i) {
        ASSERT_TRUE(solver->cut(test::randomStroke(lattice, random, 1.0)).ok());
        solver->advance(10);
    }
    ASSERT_TRUE(solver->cut(test::fullCut(lattice, 0.3)).ok());
    solver->advance(300);
    const LatticeState after = solver->state();
    EXPECT_GT(sim::countPieces(solver->pieces().value()).pieces, 1u);
    const double fallen = 9.81 * 0.5 * std::pow(700 * setup.timeStep, 2) / lattice.spacing;
    for (const glm::dvec3& x : after.positions)
        EXPECT_LT(glm::length(x), 20 + 2 * fallen);
}

TEST(CutFaces, closeTheSurfaceOfWholeCells) {
    const Lattice lattice = test::hollowBall();
    const auto solver = sim::makeReferenceSolver(test::plainSetup(lattice));
    EXPECT_TRUE(sim::freedFaces(lattice, sim::wholeCells(lattice, lattice.connections)).empty());
    std::mt19937 random(26);
    for (int i = 0; i < 4; ++i)
        ASSERT_TRUE(solver->cut(test::randomStroke(lattice, random, 0.3)).ok());
    const std::vector<bool> whole = sim::wholeCells(lattice, solver->state().connections);
    const auto broken = std::size_t(std::count(whole.begin(), whole.end(), false));
    ASSERT_GT(broken, 5u);
    ASSERT_LT(broken, whole.size());
    // Built anew of the whole cells alone, the lattice has exactly these outer faces.
    std::vector<sim::LatticeCell> cells;
    for (std::size_t i = 0; i < whole.size(); ++i)
        if (whole[i])
            cells.push_back(lattice.cells[i]);
    const Lattice rest = sim::latticeFromCells(cells, lattice.spacing, glm::dvec3(0));
    using Corners = std::array<std::array<double, 3>, 3>;
    const auto add = [](std::multiset<Corners>& faces, const Lattice& of, const glm::uvec3& face) {
        Corners corners;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 p = glm::dvec3(of.nodes[face[i]]);
            corners[std::size_t(i)] = {p.x, p.y, p.z};
        }
        faces.insert(corners);
    };
    // Both number their nodes in the order z, y, x, so faces start at the same corner.
    glm::ivec3 low = cells[0].grid;
    for (const sim::LatticeCell& cell : cells)
        low = glm::min(low, cell.grid);
    std::multiset<Corners> expected, got;
    for (const glm::uvec3& face : rest.boundary)
        add(expected, rest, face);
    std::set<std::array<std::uint32_t, 3>>
        outer; // of the uncut lattice, told apart by what bounds a whole cell
    for (const glm::uvec3& face : sim::freedFaces(lattice, whole))
        add(got, lattice, face);
    EXPECT_GT(got.size(), 10u);
    if (low != glm::ivec3(0))
        GTEST_SKIP() << "the strokes broke a whole side of the ball: choose another seed";
    for (const Corners& face : got)
        EXPECT_TRUE(expected.contains(face));
    // The others are outer faces of the uncut lattice.
    std::multiset<Corners> before;
    for (const glm::uvec3& face : lattice.boundary)
        add(before, lattice, face);
    for (const Corners& face : expected)
        EXPECT_TRUE(got.contains(face) != before.contains(face));
}
