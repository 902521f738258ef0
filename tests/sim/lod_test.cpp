// Levels of detail: affine motions are handed over as they are, momentum to rounding, free fall in step, and
// the fine shape comes back.
#include "sim/lod.h"
#include "sim/packed_normal.h"
#include "tests/sim/cut_strokes.h"
#include "tests/sim/lod_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace serosa;
using sim::LatticeState;
using sim::LodTransfer;

namespace {

constexpr double kFloat = 2e-6; // weights are float32

sim::SolverSetup plain() {
    sim::SolverSetup setup;
    setup.tissue.dampingTime = 0.0002;
    return setup;
}

const test::Levels& ball() {
    static const test::Levels levels(test::dentedBall(0.05), 0.005, plain());
    return levels;
}

/// World position x -> f(x) and velocity g(x), m and m/s, of a setup's nodes.
template <class Place, class Velocity>
LatticeState moved(const sim::SolverSetup& setup, const Place& place, const Velocity& velocity) {
    const sim::Lattice& lattice = *setup.lattice;
    LatticeState state = sim::restState(lattice);
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
        const glm::dvec3 rest = lattice.toWorld(lattice.restPosition(i));
        state.positions[i] = lattice.toLattice(place(rest));
        state.increments[i] = velocity(rest) * setup.timeStep / lattice.spacing;
    }
    return state;
}

const glm::dvec3 kMiddle(0.013, 1.1, -0.2);
glm::dvec3 sheared(const glm::dvec3& x) {
    const glm::dmat3 shear(1.1, 0.2, 0, -0.3, 0.9, 0.1, 0.05, 0, 1.2);
    return kMiddle + shear * (x - kMiddle) + glm::dvec3(0.02, -0.01, 0.03);
}
glm::dvec3 turning(const glm::dvec3& x) {
    return glm::dvec3(0.5, 1, -0.2) + glm::cross(glm::dvec3(2, -1, 4), x - kMiddle);
}
glm::dvec3 wavy(const glm::dvec3& x) {
    return sheared(x) + 0.004 * glm::dvec3(std::sin(70 * x.y), std::sin(60 * x.z), std::cos(90 * x.x));
}

void expectMomentum(const sim::SolverSetup& from, const LatticeState& before, const sim::SolverSetup& to,
                    const LatticeState& after) {
    const sim::Momentum p = sim::momentumOf(from, before), q = sim::momentumOf(to, after);
    EXPECT_LT(glm::length(q.linear - p.linear), 1e-9 * glm::length(p.linear));
    EXPECT_LT(glm::length(q.angular - p.angular), 1e-9 * glm::length(p.angular));
}

} // namespace

TEST(Lod, levelsHoldTheSameMass) {
    double masses[3];
    for (std::size_t level = 0; level < 3; ++level) {
        const sim::SolverSetup& setup = ball().setups[level];
        double sum = 0;
        for (std::size_t i = 0; i < setup.lattice->nodeCount(); ++i)
            sum += setup.lattice->massShare(i);
        masses[level] = sum * setup.tissue.nodeMass(setup.lattice->spacing);
        EXPECT_NEAR(setup.tissue.density, 1000, 5); // by no more than the rounding of fills
    }
    EXPECT_NEAR(masses[1], masses[0], 1e-12 * masses[0]);
    EXPECT_NEAR(masses[2], masses[0], 1e-12 * masses[0]);
}

TEST(Lod, gridsAreNested) {
    for (std::size_t level = 1; level < 3; ++level) {
        const sim::Lattice &fine = *ball().lattices[level - 1], &coarse = *ball().lattices[level];
        const glm::dvec3 at = fine.toLattice(coarse.origin);
        EXPECT_LT(glm::distance(at, glm::round(at)), 1e-9);
        const sim::LodRows rows = sim::trilinearRows(coarse, fine);
        for (const sim::LodEntry& entry : rows.entries) // every fine node lies in a coarse cell
            EXPECT_TRUE(entry.weight >= 0 && entry.weight <= 1);
    }
}

TEST(Lod, affineMotionsAreHandedOverAsTheyAre) {
    for (std::size_t a = 0; a < 3; ++a)
        for (const std::size_t b : {a + 1, a - 1}) {
            if (b > 2)
                continue;
            const sim::SolverSetup &from = ball().setups[a], &to = ball().setups[b];
            const LodTransfer transfer = LodTransfer::make(from, to);
            const LatticeState before = moved(from, sheared, turning), expected = moved(to, sheared, turning);
            const LatticeState after = sim::transferState(transfer, *to.lattice, before, {}, 0, 7);
            EXPECT_EQ(after.step, 7);
            expectMomentum(from, before, to, after);
            // Lumped masses lie further out on the coarser lattice, so that it turns more slowly: up to that
            // rigid motion, which changes no distance, velocities are as they were.
            double off = 0, fastest = 0, parting = 0;
            for (std::size_t i = 0; i < after.positions.size(); ++i) {
                off = std::max(off, glm::distance(after.positions[i], expected.positions[i]));
                fastest = std::max(fastest, glm::length(expected.increments[i]));
                const std::size_t j = (i * 7 + 13) % after.positions.size();
                const glm::dvec3 difference = after.increments[i] - expected.increments[i] -
                                              (after.increments[j] - expected.increments[j]);
                const glm::dvec3 apart = after.positions[i] - after.positions[j];
                parting = std::max(parting, std::abs(glm::dot(difference, apart)) /
                                                std::max(glm::length(apart), 1e-3));
            }
            EXPECT_LT(off, 20 * kFloat) << a << b;
            EXPECT_LT(parting, 20 * kFloat * fastest) << a << b;
        }
}

TEST(Lod, momentumStaysWhateverTheMotion) {
    std::mt19937 random(3);
    for (int i = 0; i < 12; ++i) {
        test::Levels levels(test::dentedBall(0.04), 0.006, plain());
        if (i % 2)
            levels.fixBelow(1.09);
        const std::size_t a = std::size_t(i) % 3, b = a == 0 ? 1 : a == 2 ? 1 : i % 4 < 2 ? 0 : 2;
        LatticeState before = moved(levels.setups[a], wavy, turning);
        for (glm::dvec3& u : before.increments)
            for (int axis = 0; axis < 3; ++axis)
                u[axis] += test::number(random, -0.05, 0.05);
        for (std::size_t node = 0; i % 2 && node < before.increments.size(); ++node)
            if (levels.setups[a].fixed[node])
                before.increments[node] = glm::dvec3(0);
        const LodTransfer transfer = LodTransfer::make(levels.setups[a], levels.setups[b]);
        const LatticeState after = sim::transferState(transfer, *levels.lattices[b], before, {}, 0, 0);
        expectMomentum(levels.setups[a], before, levels.setups[b], after);
        for (std::size_t node = 0; i % 2 && node < after.increments.size(); ++node)
            if (levels.setups[b].fixed[node]) {
                EXPECT_EQ(after.increments[node], glm::dvec3(0));
                EXPECT_EQ(after.positions[node], levels.lattices[b]->restPosition(node));
            }
    }
}

TEST(Lod, theFineShapeComesBackAndTurnsWithTheBody) {
    const sim::SolverSetup &fine = ball().setups[0], &coarse = ball().setups[1];
    const LodTransfer down = LodTransfer::make(fine, coarse), up = LodTransfer::make(coarse, fine);
    const LatticeState before = moved(fine, wavy, turning);
    const LatticeState middle = sim::transferState(down, *coarse.lattice, before, {}, 0, 0);
    const sim::LodDetail detail = sim::detailOf(up, middle, before);
    const LatticeState again = sim::transferState(up, *fine.lattice, middle, {}, 0, 0, detail);
    const LatticeState plainly = sim::transferState(up, *fine.lattice, middle, {}, 0, 0);
    double off = 0, lost = 0;
    for (std::size_t i = 0; i < again.positions.size(); ++i) {
        off = std::max(off, glm::distance(again.positions[i], before.positions[i]));
        lost = std::max(lost, glm::distance(plainly.positions[i], before.positions[i]));
    }
    EXPECT_LT(off, 1e-9);
    EXPECT_GT(lost, 0.02); // without detail something is missing
    // The coarse lattice turns by a quarter and is stretched: so is the detail.
    const glm::dmat3 turn(0, 1.3, 0, -1.3, 0, 0, 0, 0, 1.3);
    LatticeState turned = middle;
    for (glm::dvec3& x : turned.positions)
        x = turn * x;
    const LatticeState back = sim::transferState(up, *fine.lattice, turned, {}, 0, 0, detail);
    for (std::size_t i = 0; i < back.positions.size(); ++i) {
        const glm::dvec3 at = coarse.lattice->toLattice(fine.lattice->toWorld(before.positions[i]));
        const glm::dvec3 expected = fine.lattice->toLattice(coarse.lattice->toWorld(turn * at));
        ASSERT_LT(glm::distance(back.positions[i], expected), 1e-9);
    }
}

TEST(Lod, freeFallKeepsItsTime) {
    sim::SolverSetup falling = plain();
    falling.gravity = {0, -9.81, 0};
    const test::Levels levels(test::dentedBall(0.05), 0.005, falling);
    for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 0}}) {
        const sim::SolverSetup &from = levels.setups[a], &to = levels.setups[b];
        ASSERT_NE(from.timeStep, to.timeStep);
        const auto solver = sim::makeReferenceSolver(from), other = sim::makeReferenceSolver(to);
        const int frames = 6, steps = int(std::lround(1 / (60 * from.timeStep)));
        solver->setState(sim::startState(from));
        solver->advance(frames * steps - 1);
        const std::vector<glm::dvec3> before = solver->state().increments;
        solver->advance(1);
        const int otherSteps = int(std::lround(1 / (60 * to.timeStep)));
        const LodTransfer transfer = LodTransfer::make(from, to);
        other->setState(sim::transferState(transfer, *to.lattice, solver->state(), before,
                                           sim::lodLead(from.timeStep, to.timeStep),
                                           std::int64_t(frames) * otherSteps));
        other->advance(frames * otherSteps);
        const double time = 2.0 * frames / 60, fall = 0.5 * 9.81 * time * time / to.lattice->spacing;
        const LatticeState after = other->state();
        for (std::size_t i = 0; i < after.positions.size(); ++i)
            EXPECT_NEAR(after.positions[i].y - to.lattice->restPosition(i).y, -fall, 1e-4 * fall);
    }
}

TEST(Lod, normalsAreThoseOfTheShape) {
    const LodTransfer transfer = LodTransfer::make(ball().setups[0], ball().setups[1]);
    const LatticeState rest = sim::restState(*ball().lattices[0]);
    const LatticeState after = sim::transferState(transfer, *ball().lattices[1], rest, {}, 0, 0);
    EXPECT_EQ(after.normals, sim::restState(*ball().lattices[1]).normals);
    EXPECT_EQ(after.positions, sim::restState(*ball().lattices[1]).positions);
}
