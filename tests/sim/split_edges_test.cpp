// Long edges are split, and the solid is the same.
#include "sim/mesh_check.h"
#include "sim/split_edges.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace serosa;

namespace {

double longestEdge(const sim::TriangleMesh& mesh) {
    double longest = 0;
    for (const glm::uvec3& face : mesh.faces)
        for (int i = 0; i < 3; ++i)
            longest =
                std::max(longest, glm::distance(mesh.positions[face[i]], mesh.positions[face[(i + 1) % 3]]));
    return longest;
}

/// test::ballMesh with one vertex a place.
sim::TriangleMesh ball(int levels) {
    const sim::TriangleMesh loose = test::ballMesh(1, levels);
    sim::TriangleMesh mesh;
    std::vector<std::uint32_t> vertexOf;
    for (const glm::dvec3& p : loose.positions) {
        const auto found = std::find_if(mesh.positions.begin(), mesh.positions.end(),
                                        [&](const glm::dvec3& q) { return glm::distance(p, q) < 1e-9; });
        vertexOf.push_back(std::uint32_t(found - mesh.positions.begin()));
        if (found == mesh.positions.end())
            mesh.positions.push_back(p);
    }
    for (const glm::uvec3& face : loose.faces)
        mesh.faces.emplace_back(vertexOf[face.x], vertexOf[face.y], vertexOf[face.z]);
    return mesh;
}

} // namespace

TEST(SplitEdges, theSolidIsTheSame) {
    const sim::TriangleMesh coarse = ball(1);
    for (const double longest : {0.5, 0.3, 0.1, 0.03}) {
        sim::TriangleMesh fine = coarse;
        ASSERT_TRUE(sim::splitLongEdges(fine, longest));
        EXPECT_LE(longestEdge(fine), longest);
        const Status closed = sim::checkClosedSolid(fine, "ball");
        EXPECT_TRUE(closed.ok()) << closed.error().message;
        EXPECT_NEAR(fine.volume(), coarse.volume(), 1e-10);
        EXPECT_NEAR(fine.area(), coarse.area(), 1e-10);
        for (std::size_t v = 0; v < coarse.positions.size(); ++v)
            ASSERT_EQ(fine.positions[v], coarse.positions[v]);
    }
}

TEST(SplitEdges, fineOnesStay) {
    sim::TriangleMesh mesh = ball(3);
    const sim::TriangleMesh before = mesh;
    EXPECT_FALSE(sim::splitLongEdges(mesh, 1.0001 * longestEdge(mesh)));
    EXPECT_EQ(mesh.faces, before.faces);
    EXPECT_TRUE(mesh.normals.empty());
}

TEST(SplitEdges, ofOneFaceAsManyAsAreLong) {
    sim::TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}};
    mesh.faces = {{0, 1, 2}};
    sim::TriangleMesh one = mesh, two = mesh, three = mesh;
    ASSERT_TRUE(sim::splitLongEdges(one, 4.0)); // 5: halves of 2.5, which the median divides
    EXPECT_EQ(one.faces.size(), 2U);
    ASSERT_TRUE(sim::splitLongEdges(two, 3.0));
    EXPECT_EQ(two.faces.size(), 3U);
    ASSERT_TRUE(sim::splitLongEdges(three, 2.9));
    EXPECT_EQ(three.faces.size(), 4U);
}

TEST(SplitEdges, whatVerticesHoldLiesBetween) {
    sim::TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    mesh.colours = {{0, 0, 0}, {200, 0, 0}, {200, 100, 0}, {0, 100, 0}};
    for (const glm::uvec3& face : mesh.faces)
        for (int i = 0; i < 3; ++i)
            mesh.uvs.emplace_back(mesh.positions[face[i]] + glm::dvec3(2, 5, 0));
    ASSERT_TRUE(sim::splitLongEdges(mesh, 0.26));
    ASSERT_EQ(mesh.uvs.size(), 3 * mesh.faces.size());
    ASSERT_EQ(mesh.colours.size(), mesh.positions.size());
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 at = mesh.positions[mesh.faces[f][int(i)]];
            EXPECT_NEAR(mesh.uvs[3 * f + i].x, at.x + 2, 1e-6);
            EXPECT_NEAR(mesh.uvs[3 * f + i].y, at.y + 5, 1e-6);
            EXPECT_NEAR(mesh.colours[mesh.faces[f][int(i)]].x, 200 * at.x, 2);
            EXPECT_NEAR(mesh.colours[mesh.faces[f][int(i)]].y, 100 * at.y, 2);
        }
}

TEST(SplitEdges, shadingStaysAsSmoothAsItWas) {
    const auto worst = [](const sim::TriangleMesh& mesh) { // radians from the ball's normal
        double angle = 0;
        const std::vector<glm::dvec3> normals = mesh.vertexNormals();
        for (std::size_t v = 0; v < normals.size(); ++v)
            angle = std::max(angle, std::acos(glm::dot(normals[v], glm::normalize(mesh.positions[v]))));
        return angle;
    };
    const sim::TriangleMesh coarse = ball(2);
    sim::TriangleMesh fine = coarse;
    ASSERT_TRUE(sim::splitLongEdges(fine, 0.05));
    EXPECT_LT(worst(fine), 1.2 * worst(coarse));
    fine.normals.clear();
    EXPECT_GT(worst(fine), 1.5 * worst(coarse)) << "flat facets are as good: else this test shows nothing";
}
