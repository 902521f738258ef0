// The share of the corrected basis: no jump over the surface, none where a normal is not defined.
#include "render/basis_choice.h"
#include "render/surface_binding.h"
#include "sim/solver.h"
#include "tests/render/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace serosa::render {
namespace {

BoundPoint pointOn(const sim::Lattice& lattice, const RestNormals& rest, const glm::uvec3& nodes,
                   const glm::dvec3& weights, const glm::dvec3& offset) {
    BoundPoint point{nodes, {}, weights, {}};
    for (int i = 0; i < 3; ++i) {
        point.corners[i] = lattice.restPosition(nodes[i]);
        point.counts[i] = rest.trust(nodes[i]);
    }
    point.vertex = point.reference() + offset;
    return point;
}

TEST(CorrectedShare, ChangesWithoutAJumpOverATriangle) {
    const sim::Lattice lattice = test::ballLattice(4.3, 1, {});
    const RestNormals rest(lattice);
    double largest = 0, smallest = 1, most = 0;
    for (const glm::uvec3& nodes : lattice.boundary) {
        double last = -1;
        for (int i = 0; i <= 100; ++i) {
            const double w = i / 100.0;
            const double share = correctedShare(
                rest, pointOn(lattice, rest, nodes, {w, 0.6 * (1 - w), 0.4 * (1 - w)}, {0.3, 0.2, 0.1}));
            if (last >= 0)
                largest = std::max(largest, std::abs(share - last));
            last = share;
            smallest = std::min(smallest, share);
            most = std::max(most, share);
        }
    }
    EXPECT_EQ(smallest, 0); // at inner corners
    EXPECT_EQ(most, 1);
    EXPECT_LE(largest, 0.08); // over a hundredth of a triangle
}

TEST(CorrectedShare, ShortOffsetsAndCutNodesNeedNone) {
    const sim::Lattice lattice = test::boxLattice(6, 6, 6, 1, {});
    const auto on = [&](const RestNormals& rest, double offset) {
        for (const glm::uvec3& nodes : lattice.boundary) // a triangle in the middle of the top
            if (lattice.nodes[nodes.x] == glm::ivec3(3, 6, 3) && lattice.nodes[nodes.y].y == 6 &&
                lattice.nodes[nodes.z].y == 6)
                return correctedShare(rest, pointOn(lattice, rest, nodes, {0.4, 0.3, 0.3}, {0, offset, 0}));
        return -1.0;
    };
    const RestNormals whole(lattice);
    EXPECT_EQ(on(whole, 0.3), 1);
    EXPECT_EQ(on(whole, 0.02), 0);
    EXPECT_GT(on(whole, 0.05), 0);
    EXPECT_LT(on(whole, 0.05), 1);
    std::vector<std::uint32_t> cut = lattice.connections;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        if (lattice.nodes[node].y == 6 && std::abs(lattice.nodes[node].x - 3) <= 1)
            cut[node] &= ~1U;
    EXPECT_EQ(on(RestNormals(lattice, cut), 0.3), 0);
}

/// The length below which eq. 3 counts as not defined, on a sheet: MS05 3.5.
TEST(RestNormals, SheetsOfOneNodeHaveNone) {
    const sim::Lattice slab = test::boxLattice(6, 1, 6, 1, {});
    std::vector<std::uint32_t> cut = slab.connections;
    for (std::size_t node = 0; node < slab.nodeCount(); ++node)
        for (std::size_t d = 0; d < 18; ++d)
            if (sim::kNeighbourOffsets[d].y != 0)
                cut[node] &= ~(1U << d);
    const RestNormals rest(slab, cut);
    for (std::uint32_t node = 0; node < slab.nodeCount(); ++node) {
        EXPECT_TRUE(rest.isCut(node));
        EXPECT_EQ(rest.trust(node), 0);
        if (slab.nodes[node].x % 6 != 0 && slab.nodes[node].z % 6 != 0) {
            EXPECT_NEAR(rest.length(node), 0, 1e-12);
        }
    }
}

TEST(RestNormals, AreThoseOfTheRestState) {
    const sim::Lattice lattice = test::ballLattice(4.3, 1, {});
    const RestNormals rest(lattice);
    const sim::LatticeState state = sim::restState(lattice);
    const auto sums = sim::restNormalSums(lattice);
    for (std::uint32_t node = 0; node < lattice.nodeCount(); ++node) {
        EXPECT_NEAR(rest.length(node), glm::length(sums[node]), 1e-12);
        if (rest.length(node) > 0.5) {
            EXPECT_LE(glm::distance(rest.normal(node), glm::normalize(sums[node])), 3e-4);
        }
    }
}

} // namespace
} // namespace serosa::render
