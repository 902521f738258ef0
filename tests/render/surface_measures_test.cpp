// The numbers behind MS05's figures, on shapes for which they are known.
#include "render/surface_measures.h"
#include "tests/render/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace serosa::render {
namespace {

/// A fan about the z axis whose rim has the radius that `radius` gives for an angle.
template <class Radius>
void fan(const Radius& radius, std::vector<glm::dvec3>& positions, std::vector<glm::uvec3>& faces) {
    constexpr int kRim = 5760;
    positions = {{3, 4, 5}};
    for (int i = 0; i < kRim; ++i) {
        const double angle = 2 * std::numbers::pi * i / kRim;
        positions.push_back(positions[0] + radius(angle) * glm::dvec3(std::cos(angle), std::sin(angle), 0.3));
        faces.emplace_back(0, i + 1, (i + 1) % kRim + 1);
    }
}

TEST(Silhouette, ACircleIsSmoothAndWavesHaveTheirHeight) {
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> faces;
    fan([](double) { return 10.0; }, positions, faces);
    EXPECT_LE(silhouetteJaggedness(positions, faces, 2, 3), 1e-6);
    faces.clear();
    fan([](double angle) { return 10 + 0.1 * std::sin(60 * angle); }, positions, faces);
    // A window of three of the wave's lengths takes it out of the mean.
    EXPECT_NEAR(silhouetteJaggedness(positions, faces, 2, 3 * 2 * std::numbers::pi * 10 / 60),
                0.1 / std::sqrt(2.0), 5e-3);
}

TEST(Silhouette, AStaircaseIsJagged) {
    const sim::Lattice lattice = test::ballLattice(8.3, 1, {});
    std::vector<glm::dvec3> nodes;
    for (std::size_t i = 0; i < lattice.nodeCount(); ++i)
        nodes.push_back(lattice.restPosition(i));
    const sim::TriangleMesh ball = test::ballMesh(30, 8.3, {});
    const double steps = silhouetteJaggedness(nodes, lattice.boundary, 0, 3);
    EXPECT_GT(steps, 0.1);
    EXPECT_LT(silhouetteJaggedness(ball.positions, ball.faces, 0, 3), 0.05 * steps);
}

TEST(SurfaceDamage, CountsStretchedEdgesAndTurnedFaces) {
    const std::vector<glm::dvec3> flat{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::vector<glm::uvec3> faces{{0, 1, 2}, {0, 2, 3}};
    SurfaceDamage damage = surfaceDamage(flat, flat, faces);
    EXPECT_EQ(damage.largestStretch, 1);
    EXPECT_EQ(damage.flipped, 0U);
    std::vector<glm::dvec3> folded = flat;
    folded[3] = {1, -1, 0}; // over the diagonal and beyond
    damage = surfaceDamage(folded, flat, faces);
    EXPECT_EQ(damage.largestStretch, 2); // from 2 to 3
    EXPECT_EQ(damage.flipped, 1U);
    folded[3].x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(surfaceDamage(folded, flat, faces).largestStretch));
    EXPECT_EQ(surfaceDamage(folded, flat, faces).flipped, 1U);
}

TEST(Angles, MedianAndLargest) {
    const glm::dvec3 x(1, 0, 0);
    std::vector<glm::dvec3> turned;
    for (const double degrees : {0.0, 10.0, 170.0})
        turned.emplace_back(std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees)), 0);
    const AngleSpread angles = anglesBetween({x, x, x}, turned);
    EXPECT_NEAR(angles.median, 10, 1e-9);
    EXPECT_NEAR(angles.largest, 170, 1e-9);
    EXPECT_TRUE(std::isnan(quantile({1, std::nan(""), 2}, 0.5)));
}

} // namespace
} // namespace serosa::render
