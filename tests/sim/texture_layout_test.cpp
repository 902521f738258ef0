// Both layouts must lead from each node to the texel of each of its neighbours.
#include "shaders/shared_constants.h"
#include "sim/texture_layout.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace serosa;

namespace {

/// Cells at random: holes of every width in rows.
sim::Lattice sieve(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<sim::LatticeCell> cells;
    for (int z = 0; z < 6; ++z)
        for (int y = 0; y < 7; ++y)
            for (int x = 0; x < 12; ++x)
                if (random() % 5 == 0)
                    cells.push_back({{x, y, z}, 255});
    return sim::latticeFromCells(cells, 1, glm::dvec3(0));
}

// Row of a neighbour in TextureLayout::rowOffsets, by (dy, dz); -1: the node's own row.
int rowOf(const glm::ivec3& offset) {
    const glm::ivec2 rows[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    for (int i = 0; i < 8; ++i)
        if (rows[i] == glm::ivec2(offset.y, offset.z))
            return i;
    return -1;
}

} // namespace

TEST(TextureLayout, rowsFindEveryNeighbour) {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const sim::Lattice lattice = sieve(seed);
        const sim::TextureLayout layout = sim::makeTextureLayout(lattice, SRS_LAYOUT_ROWS, 16384).value();
        const auto linear = [&layout](std::size_t node) {
            return int(layout.texelOfNode[node].y) * layout.width + int(layout.texelOfNode[node].x);
        };
        std::set<int> used;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
            EXPECT_TRUE(used.insert(linear(node)).second);
            for (int d = 0; d < 18; ++d) {
                const std::int64_t other = lattice.neighbour(node, d);
                if (other < 0)
                    continue;
                const glm::ivec3 offset = sim::kNeighbourOffsets[std::size_t(d)];
                const int row = rowOf(offset);
                const int shift =
                    row < 0 ? 0 : layout.rowOffsets[std::size_t(linear(node)) * 8 + std::size_t(row)];
                ASSERT_EQ(linear(node) + shift + offset.x, linear(std::size_t(other)))
                    << "seed " << seed << " d " << d;
            }
        }
        EXPECT_EQ(layout.width & (layout.width - 1), 0) << "a power of two, for shifts";
    }
}

TEST(TextureLayout, gridFindsEveryNeighbour) {
    const sim::Lattice lattice = sieve(4);
    const sim::TextureLayout layout = sim::makeTextureLayout(lattice, SRS_LAYOUT_GRID, 16384).value();
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; ++d)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                const glm::ivec3 offset = sim::kNeighbourOffsets[std::size_t(d)];
                EXPECT_EQ(glm::ivec2(layout.texelOfNode[node]) +
                              glm::ivec2(offset.x, offset.y + layout.gridStride.z * offset.z),
                          glm::ivec2(layout.texelOfNode[std::size_t(other)]));
            }
}

TEST(TextureLayout, choosesRowsForSparseAndStripsForFull) {
    EXPECT_EQ(sim::makeTextureLayout(test::blockLattice(8, 8, 8), -1, 16384)->kind, SRS_LAYOUT_GRID);
    EXPECT_EQ(sim::makeTextureLayout(
                  sim::latticeFromCells({{{0, 0, 0}, 1}, {{20, 20, 20}, 1}}, 1, glm::dvec3(0)), -1, 16384)
                  ->kind,
              SRS_LAYOUT_ROWS);
}

TEST(TextureLayout, saysWhatDoesNotFit) {
    const sim::Lattice lattice = test::blockLattice(10, 10, 10);
    const auto strip = sim::makeTextureLayout(lattice, SRS_LAYOUT_GRID, 100);
    ASSERT_FALSE(strip.ok());
    EXPECT_NE(strip.error().message.find("11 x 121"), std::string::npos) << strip.error().message;
    EXPECT_FALSE(sim::makeTextureLayout(lattice, SRS_LAYOUT_ROWS, 16).ok());
    EXPECT_EQ(sim::makeTextureLayout(lattice, -1, 100)->kind, SRS_LAYOUT_ROWS) << "falls back to what fits";
}
