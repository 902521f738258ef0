// The bend of figure 6 in closed form: lengths along the middle, right angles, radius.

#include "app/pose.h"
#include "sim/packed_normal.h"
#include "sim/solver.h"

#include <gtest/gtest.h>

namespace serosa::app {
namespace {

/// A bar of 8 x 2 x 1 cells of 1 cm.
sim::Lattice bar() {
    std::vector<sim::LatticeCell> cells;
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 2; ++y)
            cells.push_back({{x, y, 0}, 255});
    return sim::latticeFromCells(cells, 0.01, glm::dvec3(0));
}

TEST(Bend, WithoutCurvatureIsRest) {
    const sim::Lattice lattice = bar();
    EXPECT_EQ(bentState(lattice, 0).positions, sim::restState(lattice).positions);
    const sim::LatticeState slight = bentState(lattice, 1e-9);
    for (std::size_t i = 0; i < lattice.nodeCount(); ++i)
        EXPECT_LT(glm::distance(slight.positions[i], lattice.restPosition(i)), 1e-8);
}

TEST(Bend, PutsTheMiddleOnACircleOfItsRadius) {
    const sim::Lattice lattice = bar();
    const double radius = 0.05; // m: 5 spacings
    const sim::LatticeState state = bentState(lattice, 1 / radius);
    // Nodes at grid height 1 are the centre line; the middle of the bar is at x = 4.
    const std::size_t middle = std::size_t(lattice.nodeAt({4, 1, 0}));
    const glm::dvec3 centre = state.positions[middle] - glm::dvec3(0, 5, 0);
    for (int x = 0; x <= 8; ++x) {
        const glm::dvec3 p = state.positions[std::size_t(lattice.nodeAt({x, 1, 0}))];
        EXPECT_NEAR(glm::distance(p, centre), 5, 1e-12) << x;
        EXPECT_NEAR(std::atan2(p.x - centre.x, p.y - centre.y), (x - 4) / 5.0, 1e-12) << x; // arc length
        const glm::dvec3 above = state.positions[std::size_t(lattice.nodeAt({x, 2, 0}))];
        EXPECT_NEAR(glm::distance(above, centre), 6, 1e-12) << x;
    }
    EXPECT_LT(state.positions[std::size_t(lattice.nodeAt({8, 1, 0}))].y,
              state.positions[middle].y); // ends go down
}

TEST(Bend, NormalsFollowAndPointOutward) {
    const sim::Lattice lattice = bar();
    const std::vector<std::uint32_t> rest = latticeNormals(lattice, sim::restState(lattice).positions);
    EXPECT_EQ(rest, sim::restState(lattice).normals);
    const sim::LatticeState state = bentState(lattice, 1 / 0.05);
    const glm::vec3 top = sim::unpackNormal(state.normals[std::size_t(lattice.nodeAt({4, 2, 0}))]);
    EXPECT_GT(top.y, 0.5f);
    EXPECT_NEAR(top.x, 0, 1e-3);
}

TEST(Bend, RefusesToTurnInsideOut) {
    EXPECT_TRUE(checkBend(bar(), 0.0101).ok());
    EXPECT_FALSE(checkBend(bar(), 0.01).ok()); // the bar reaches 1 cm below its middle
}

} // namespace
} // namespace serosa::app
