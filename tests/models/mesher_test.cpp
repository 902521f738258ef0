// The mesher on shapes whose volume, genus and distance are known.
#include "mesh_measures.h"
#include "models/mesher.h"
#include "models/tube.h"

#include <gtest/gtest.h>

namespace serosa::models {
namespace {

MeshSource ball() {
    MeshSource source;
    source.distance = [](const Point& p) { return sphere(p, {1.3, -2.1, 0.7}, 20); };
    source.lowest = Point(-23);
    source.highest = Point(23);
    return source;
}

void expectSound(const sim::TriangleMesh& mesh, const MeshSource& source, std::size_t faces) {
    EXPECT_EQ(test::manifoldFault(mesh), "");
    EXPECT_EQ(test::contacts(mesh), 0u);
    EXPECT_GE(mesh.faces.size(), faces);
    EXPECT_LE(static_cast<double>(mesh.faces.size()), 1.05 * static_cast<double>(faces));
    EXPECT_GT(test::leastAngle(mesh), 15.0);
    for (const Point& p : mesh.positions)
        ASSERT_LT(std::abs(source.distance(p)), 1e-6);
}

TEST(Mesher, BallHasItsVolumeAndOneShell) {
    const MeshSource source = ball();
    for (const std::size_t faces : {1000u, 6000u}) {
        const auto mesh = meshShape(source, faces);
        ASSERT_TRUE(mesh.ok());
        expectSound(*mesh, source, faces);
        const auto shells = test::shellsOf(*mesh);
        ASSERT_EQ(shells.size(), 1u);
        EXPECT_EQ(shells[0].genus, 0);
        // n equilateral faces lie on average L^2 / 8R below the sphere, with L^2 = 16 pi R^2 / (sqrt(3) n):
        // they lack 10.9 / n of its volume. Other faces lack more.
        const double lacking = 1 - shells[0].volume / (4.0 / 3.0 * glm::radians(180.0) * 8000);
        EXPECT_GT(lacking, 10.0 / static_cast<double>(mesh->faces.size()));
        EXPECT_LT(lacking, 12.0 / static_cast<double>(faces));
    }
}

TEST(Mesher, TorusHasOneHandle) {
    MeshSource source;
    source.distance = [](const Point& p) { return torus(p, {0, 0, 0}, {0, 0.6, 0.8}, 15, 5); };
    source.lowest = Point(-21);
    source.highest = Point(21);
    const auto mesh = meshShape(source, 4000);
    ASSERT_TRUE(mesh.ok());
    expectSound(*mesh, source, 4000);
    const auto shells = test::shellsOf(*mesh);
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_EQ(shells[0].genus, 1);
    const double pi = glm::radians(180.0);
    EXPECT_NEAR(shells[0].volume, 2 * pi * pi * 15 * 25, 0.01 * 2 * pi * pi * 15 * 25);
}

TEST(Mesher, HollowBallKeepsAThinWall) {
    MeshSource source = ball();
    source.distance = [](const Point& p) {
        return carve(sphere(p, {1.3, -2.1, 0.7}, 20), sphere(p, {1.3, -2.1, 0.7}, 18), 0.5);
    };
    source.thinnest = 2;
    const auto mesh = meshShape(source, 5000);
    ASSERT_TRUE(mesh.ok());
    expectSound(*mesh, source, 5000);
    const auto shells = test::shellsOf(*mesh);
    ASSERT_EQ(shells.size(), 2u);
    EXPECT_GT(shells[0].volume, 0);
    EXPECT_LT(shells[1].volume, 0);
}

TEST(Mesher, FewFacesThatWouldTearAWallAreRefused) {
    MeshSource source = ball();
    source.thinnest = 0.05;
    EXPECT_FALSE(meshShape(source, 1000).ok()) << "a lattice of 0.05 mm over 43 mm has far too many points";
}

TEST(Sdf, EllipsoidDistanceIsThatOfItsClosestPoint) {
    const Point e(20, 46, 12);
    for (double a = 0.1; a < 3; a += 0.37)
        for (double b = 0; b < 6.2; b += 0.71) {
            const Point on(e.x * std::sin(a) * std::cos(b), e.y * std::cos(a),
                           e.z * std::sin(a) * std::sin(b));
            const Point n = glm::normalize(on / (e * e));
            EXPECT_NEAR(ellipsoid(on + 7.0 * n, e), 7.0, 1e-7);
            EXPECT_NEAR(ellipsoid(on - 2.0 * n, e), -2.0, 1e-7); // less than the least radius of curvature
        }
}

TEST(Sdf, BlendNeverExceedsTheUnionAndLeavesFarPartsAlone) {
    for (double a = -4; a < 4; a += 0.3)
        for (double b = -4; b < 4; b += 0.3) {
            const double d = blend(a, b, 2);
            EXPECT_LE(d, std::min(a, b));
            EXPECT_GE(d, std::min(a, b) - 0.5);
            if (std::abs(a - b) >= 2) {
                EXPECT_EQ(d, std::min(a, b));
            }
        }
}

TEST(Sdf, FlatEndOfATubeIsCutAtRightAngles) {
    const Tube tube({{{0, 0, 0}, 5}, {{0, 10, 0}, 5}}, Tube::End::round, Tube::End::flat, 2);
    EXPECT_NEAR(tube.distance({0, 17 - 1e-9, 0}), 0, 1e-6);
    EXPECT_NEAR(tube.distance({3, 17, 0}), 0, 1e-6);
    EXPECT_NEAR(tube.distance({5, 5, 0}), 0, 1e-9);
    EXPECT_NEAR(tube.distance({0, -5, 0}), 0, 1e-9);
    EXPECT_NEAR(tube.distance({3, 20, 0}), 3, 1e-6);
}

} // namespace
} // namespace serosa::models
