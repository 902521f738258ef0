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

} // namespace

TEST(SplitEdges, theSolidIsTheSame) {
    const sim::TriangleMesh coarse = test::ballMesh(1, 1);
    for (const double longest : {0.5, 0.3, 0.1, 0.03}) {
        sim::TriangleMesh fine = coarse;
        ASSERT_TRUE(sim::splitLongEdges(fine, longest));
        EXPECT_LE(longestEdge(fine), longest);
        EXPECT_TRUE(sim::checkClosedSolid(fine, "ball").ok());
        EXPECT_NEAR(fine.volume(), coarse.volume(), 1e-12);
        EXPECT_NEAR(fine.area(), coarse.area(), 1e-12);
        for (std::size_t v = 0; v < coarse.positions.size(); ++v)
            ASSERT_EQ(fine.positions[v], coarse.positions[v]);
    }
}

TEST(SplitEdges, fineOnesStay) {
    sim::TriangleMesh mesh = test::ballMesh(1, 3);
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
    const sim::TriangleMesh coarse = test::ballMesh(1, 2);
    sim::TriangleMesh fine = coarse;
    ASSERT_TRUE(sim::splitLongEdges(fine, 0.05));
    const std::vector<glm::dvec3> normals = fine.vertexNormals();
    for (std::size_t v = 0; v < normals.size(); ++v) // a flat facet's would be up to 10 degrees off
        ASSERT_GT(glm::dot(normals[v], glm::normalize(fine.positions[v])), std::cos(glm::radians(2.5)));
}
