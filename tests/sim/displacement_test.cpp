// Displacements of a lattice: a rigid translation gives the same vector everywhere, points read back to the
// state.
#include "sim/displacement.h"
#include "sim/solver.h"
#include "tests/sim/cut_strokes.h"

#include <gtest/gtest.h>

#include <cstring>

using namespace serosa;

TEST(Displacement, ofATranslationIsTheTranslation) {
    const sim::Lattice lattice = test::hollowBall(7); // 3 mm, from (50, 1200, -300) mm
    sim::LatticeState state = sim::restState(lattice);
    const glm::dvec3 moved(1.5, -0.25, 0.125); // lattice units
    for (glm::dvec3& position : state.positions)
        position += moved;
    const sim::DisplacementGrid grid = sim::displacementGrid(lattice, state);
    EXPECT_EQ(grid.size, lattice.nodeDims);
    EXPECT_DOUBLE_EQ(grid.spacing, 3);
    std::size_t nodes = 0;
    for (int z = 0, place = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x, ++place) {
                const std::int64_t node = lattice.nodeAt({x, y, z});
                ASSERT_EQ(grid.hasNode[std::size_t(place)], node >= 0 ? 1 : 0);
                const glm::vec3 expected = node >= 0 ? glm::vec3(4.5F, -0.75F, 0.375F) : glm::vec3(0);
                ASSERT_LT(glm::length(grid.vectors[std::size_t(place)] - expected), 1e-6F);
                if (node < 0)
                    continue;
                ++nodes;
                const glm::dvec3 rest = 1e3 * lattice.toWorld(lattice.restPosition(std::size_t(node)));
                EXPECT_LT(glm::length(grid.origin + grid.spacing * glm::dvec3(x, y, z) - rest), 1e-9);
            }
    EXPECT_EQ(nodes, lattice.nodeCount());
    EXPECT_LT(nodes, grid.vectors.size()) << "the ball is hollow: some places have none";
}

TEST(Displacement, pointsReadBackToTheState) {
    const sim::Lattice lattice = test::hollowBall(5);
    sim::LatticeState state = sim::restState(lattice);
    std::mt19937 random(7);
    for (glm::dvec3& position : state.positions)
        position += glm::dvec3(test::number(random, -1, 1), test::number(random, -1, 1), 0.5);
    const std::string ply = sim::displacementPly(lattice, state);
    const std::size_t header = ply.find("end_header\n") + 11;
    EXPECT_EQ(ply.rfind("ply\nformat binary_little_endian 1.0\n", 0), 0u);
    EXPECT_NE(ply.find("element vertex " + std::to_string(lattice.nodeCount()) + "\n"), std::string::npos);
    ASSERT_EQ(ply.size() - header, lattice.nodeCount() * 48);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        double values[6];
        std::memcpy(values, ply.data() + header + 48 * node, sizeof values);
        const glm::dvec3 rest(values[0], values[1], values[2]), by(values[3], values[4], values[5]);
        EXPECT_LT(glm::length(1e-3 * rest - lattice.toWorld(lattice.restPosition(node))), 1e-12);
        EXPECT_LT(glm::length(1e-3 * (rest + by) - lattice.toWorld(state.positions[node])), 1e-12);
    }
}
