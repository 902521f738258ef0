// Exact fills: against volumes known in closed form.
#include "sim/cell_fills.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <numeric>

using namespace serosa;
using sim::CellGrid;

namespace {
double total(const std::vector<double>& fills) {
    return std::accumulate(fills.begin(), fills.end(), 0.0);
}
} // namespace

TEST(CellFills, boxThatCutsCellsHasEachCellsShare) {
    const CellGrid grid{glm::dvec3(0), 1, {3, 3, 3}};
    const std::vector<double> fills =
        sim::cellFills(test::boxMesh({0.25, 0.5, 0.75}, {2.5, 2.25, 2.125}), grid);
    const glm::dvec3 share[3] = {{0.75, 0.5, 0.25}, {1, 1, 1}, {0.5, 0.25, 0.125}};
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x)
                EXPECT_NEAR(fills[grid.index(x, y, z)], share[x].x * share[y].y * share[z].z, 1e-14)
                    << x << y << z;
}

TEST(CellFills, sumIsTheVolumeOfABallAnywhere) {
    for (const glm::dvec3 offset :
         {glm::dvec3(0), glm::dvec3(0.31, -0.17, 0.43), glm::dvec3(1600, -850, 300)}) {
        sim::TriangleMesh ball = test::ballMesh(4.3, 4);
        for (glm::dvec3& p : ball.positions)
            p += offset;
        const CellGrid grid = sim::gridAround(ball.lowest(), ball.highest(), 0.7);
        const double volume = total(sim::cellFills(ball, grid)) * 0.7 * 0.7 * 0.7;
        sim::TriangleMesh centred = test::ballMesh(4.3, 4);
        EXPECT_NEAR(volume / centred.volume(), 1, 1e-9);
    }
}

TEST(CellFills, cavityIsOutside) {
    sim::TriangleMesh shell = test::boxMesh(glm::dvec3(0), glm::dvec3(5));
    test::append(shell, test::boxMesh(glm::dvec3(1.5), glm::dvec3(3.5)), true);
    const CellGrid grid{glm::dvec3(0), 1, {5, 5, 5}};
    const std::vector<double> fills = sim::cellFills(shell, grid);
    EXPECT_NEAR(fills[grid.index(2, 2, 2)], 0, 1e-14);
    EXPECT_NEAR(fills[grid.index(1, 1, 1)], 1 - 0.125, 1e-14);
    EXPECT_NEAR(total(fills), 125 - 8, 1e-12);
}

TEST(CellFills, overlapCountsOnce) {
    sim::TriangleMesh two = test::boxMesh(glm::dvec3(0), glm::dvec3(2));
    test::append(two, test::boxMesh(glm::dvec3(1), glm::dvec3(3)), false);
    const CellGrid grid{glm::dvec3(0), 1, {3, 3, 3}};
    EXPECT_NEAR(total(sim::cellFills(two, grid)), 8 + 8 - 1, 1e-12);
}

TEST(CellFills, gridHasWholeCellsForWholeExtents) {
    EXPECT_EQ(sim::gridAround({0, 0, 0}, {0.03, 0.03, 0.12}, 0.003).dims, glm::ivec3(10, 10, 40));
    EXPECT_EQ(sim::gridAround({0, 0, 0}, {0.031, 0.001, 0.12}, 0.003).dims, glm::ivec3(11, 1, 40));
}
