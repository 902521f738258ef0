// A rotation a node, on the CPU: what is known of it whatever the neighbours.
#include "render/mapping_measures.h"
#include "render/node_frames.h"
#include "tests/render/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace serosa::render {
namespace {

/// rad
double angleBetween(const glm::dquat& a, const glm::dquat& b) {
    const glm::dquat d = a * glm::conjugate(b);
    return 2 * std::atan2(glm::length(glm::dvec3(d.x, d.y, d.z)), std::abs(d.w));
}

std::vector<glm::dquat> randomRotations(int count) {
    std::mt19937 random(7);
    const auto uniform = [&] { return random() / 4294967296.0 * 2 - 1; };
    std::vector<glm::dquat> rotations;
    while (int(rotations.size()) < count) {
        const glm::dquat q(uniform(), uniform(), uniform(), uniform());
        if (glm::length(q) > 0.2 && glm::length(q) <= 1)
            rotations.push_back(glm::normalize(q));
    }
    return rotations;
}

TEST(PackedFrame, AnyRotationReturnsAndNoTurnIsExact) {
    EXPECT_EQ(unpackFrame(packFrame({1, 0, 0, 0})), glm::dquat(1, 0, 0, 0));
    for (const glm::dquat& q : randomRotations(2000))
        ASSERT_LE(angleBetween(unpackFrame(packFrame(q)), q), 4e-6);
    for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})
        for (const double w : {1e-9, 0.0, -1e-9}) { // a half turn, where the sign of w changes
            const glm::dquat q = glm::normalize(glm::dquat(w, axis.x, axis.y, axis.z));
            EXPECT_LE(angleBetween(unpackFrame(packFrame(q)), q), 4e-6);
        }
}

TEST(RotationOf, IsThePolarRotationOfWhatIsNotInverted) {
    std::mt19937 random(11);
    const auto uniform = [&] { return random() / 4294967296.0 * 2 - 1; };
    for (const glm::dquat& q : randomRotations(500)) {
        // A symmetric positive stretch of 0.5 to 1.5
        const glm::dmat3 axes =
            glm::mat3_cast(glm::normalize(glm::dquat(1.1 + uniform(), uniform(), uniform(), uniform())));
        const glm::dmat3 stretch =
            axes *
            glm::dmat3(1 + 0.5 * uniform(), 0, 0, 0, 1 + 0.5 * uniform(), 0, 0, 0, 1 + 0.5 * uniform()) *
            glm::transpose(axes);
        ASSERT_LE(angleBetween(rotationOf(glm::mat3_cast(q) * stretch), q), 1e-12);
    }
}

TEST(RotationOf, StaysARotationWhereTissueIsFlatInvertedOrGone) {
    for (const glm::dquat& q : randomRotations(200)) {
        const glm::dmat3 r = glm::mat3_cast(q);
        EXPECT_LE(angleBetween(rotationOf(r * glm::dmat3(1, 0, 0, 0, 1.2, 0, 0, 0, 0)), q), 1e-12); // flat
        EXPECT_LE(angleBetween(rotationOf(r * glm::dmat3(1, 0, 0, 0, 1.2, 0, 0, 0, -0.5)), q), 1e-9);
    }
    EXPECT_EQ(rotationOf(glm::dmat3(0)), glm::dquat(1, 0, 0, 0));
    for (const glm::dmat3& f : {glm::dmat3(-1), glm::dmat3(1, 0, 0, 0, 0, 0, 0, 0, 0)}) { // ambiguous
        EXPECT_NEAR(glm::length(rotationOf(f)), 1, 1e-12);
    }
}

/// A ball's frames when all its nodes follow `move`.
std::vector<glm::dquat> framesOf(const sim::Lattice& lattice, const FrameStencil& stencil,
                                 const std::function<glm::dvec3(const glm::dvec3&)>& move) {
    std::vector<glm::dquat> frames;
    const auto packed = nodeFrames(stencil, deformedState(lattice, move).positions);
    for (const FrameStencil::Row& row : stencil.rows)
        frames.push_back(unpackFrame(packed[row.node]));
    return frames;
}

TEST(NodeFrames, AreExactAtRestInRigidMotionAndInEvenStretch) {
    const sim::Lattice lattice = test::ballLattice(4.3, 0.004, {0.1, 1.6, -0.4});
    const FrameStencil stencil = frameStencil(lattice);
    ASSERT_GT(stencil.rows.size(), 100U);
    for (const glm::dquat& frame : framesOf(lattice, stencil, [](const glm::dvec3& q) { return q; }))
        ASSERT_EQ(frame, glm::dquat(1, 0, 0, 0));
    const glm::dvec3 stretch(1.25, 0.875, 1.125);
    for (const glm::dquat& frame :
         framesOf(lattice, stencil, [&](const glm::dvec3& q) { return stretch * q; }))
        ASSERT_EQ(frame, glm::dquat(1, 0, 0, 0));
    for (const glm::dquat& turn : randomRotations(8))
        for (const glm::dquat& frame :
             framesOf(lattice, stencil, [&](const glm::dvec3& q) { return turn * (stretch * q); }))
            ASSERT_LE(angleBetween(frame, turn), 5e-6);
}

TEST(NodeFrames, FollowABend) {
    const sim::Lattice lattice = test::boxLattice(20, 4, 4, 1.0, glm::dvec3(0));
    const FrameStencil stencil = frameStencil(lattice);
    const double radius = 40;
    const auto frames = framesOf(lattice, stencil, [&](const glm::dvec3& q) { return bend(q, {}, radius); });
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double x = lattice.restPosition(stencil.rows[i].node).x;
        const glm::dquat turn = glm::angleAxis(-x / radius, glm::dvec3(0, 0, 1));
        ASSERT_LE(angleBetween(frames[i], turn), 0.7 / radius); // one-sided neighbours lie up to 0.7 h away
    }
}

TEST(NodeFrames, ASheetOfOneNodeHasThemAndLooseNodesTakeTheNearest) {
    const sim::Lattice lattice = test::boxLattice(6, 2, 6, 1.0, glm::dvec3(0));
    // Cut all springs that leave the middle layer: it becomes a sheet of one node. Then free one node of the
    // top wholly.
    std::vector<std::uint32_t> connections = lattice.connections;
    const auto cut = [&](std::size_t node, int d) {
        if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
            connections[node] &= ~(1U << d);
            connections[std::size_t(other)] &= ~(1U << (d ^ 1));
        }
    };
    const auto free = std::size_t(lattice.nodeAt({3, 2, 3}));
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; ++d)
            if ((lattice.nodes[node].y == 1 && sim::kNeighbourOffsets[std::size_t(d)].y != 0) || node == free)
                cut(node, d);
    const FrameStencil stencil = frameStencil(lattice, connections);
    // The sheet turns one way, all above it another way; the free node flies off.
    const glm::dquat sheet = glm::angleAxis(1.0, glm::normalize(glm::dvec3(1, 2, 3))),
                     above = glm::angleAxis(-0.7, glm::dvec3(0, 0, 1));
    std::vector<glm::dvec3> positions;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        positions.push_back((lattice.nodes[node].y == 1   ? sheet
                             : lattice.nodes[node].y == 2 ? above
                                                          : glm::dquat(1, 0, 0, 0)) *
                            lattice.restPosition(node));
    positions[free] += glm::dvec3(100, 200, 300);
    const auto frames = nodeFrames(stencil, positions);
    std::size_t sheetNodes = 0;
    for (const FrameStencil::Row& row : stencil.rows)
        if (lattice.nodes[row.node].y == 1) {
            ++sheetNodes;
            ASSERT_LE(angleBetween(unpackFrame(frames[row.node]), sheet), 5e-6);
        }
    EXPECT_GT(sheetNodes, 10U);
    EXPECT_LE(angleBetween(unpackFrame(frames[free]), above), 5e-6);
}

TEST(NodeFrames, AreExactInEvenStretchWhateverConnectionsACutLeft) {
    // Neighbours that span space must count in all directions: none is taken for flat.
    const sim::Lattice lattice = test::boxLattice(2, 2, 2, 1.0, glm::dvec3(0));
    std::mt19937 random(3);
    const glm::dvec3 stretch(1.25, 0.875, 1.125);
    std::vector<glm::dvec3> positions;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        positions.push_back(stretch * lattice.restPosition(node));
    std::size_t spanning = 0;
    for (int round = 0; round < 400; ++round) {
        std::vector<std::uint32_t> left = lattice.connections;
        for (std::uint32_t& bits : left)
            bits &= std::uint32_t(random()) | (round % 2 ? std::uint32_t(random()) : 0U);
        const FrameStencil stencil = frameStencil(lattice, left);
        const auto frames = nodeFrames(stencil, positions);
        for (const FrameStencil::Row& row : stencil.rows) {
            glm::dmat3 spread(0);
            for (std::size_t d = 0; d < 18; ++d)
                if ((left[row.node] >> d) & 1U) {
                    const glm::dvec3 offset(sim::kNeighbourOffsets[d]);
                    spread += glm::outerProduct(offset, offset);
                }
            if (glm::determinant(spread) < 0.5) // of whole numbers
                continue;
            ++spanning;
            ASSERT_EQ(unpackFrame(frames[row.node]), glm::dquat(1, 0, 0, 0));
        }
    }
    EXPECT_GT(spanning, 1000U);
}

TEST(BlendFrames, IsTheSameFromEitherTriangleOfAnEdge) {
    const auto q = randomRotations(60);
    for (std::size_t i = 0; i + 3 < q.size(); i += 4) {
        const double w = 0.31;
        // The edge is (q0, q1); its third nodes differ, and so do the order and the signs.
        const glm::dquat one = blendFrames(q[i], q[i + 1], q[i + 2], {w, 1 - w, 0}),
                         other = blendFrames(q[i + 3], -q[i + 1], q[i], {0, 1 - w, w});
        ASSERT_LE(angleBetween(one, other), 1e-7);
    }
}

} // namespace
} // namespace serosa::render
