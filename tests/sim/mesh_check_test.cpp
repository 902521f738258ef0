// Closed solids are accepted, everything else is refused with the place of the first fault and a hint;
// volumes, areas, genus and crossings are compared with what geometry says.
#include "sim/mesh_check.h"
#include "sim/mesh_crossings.h"
#include "tests/sim/mesh_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace serosa::sim {
namespace {

void expectRefused(const TriangleMesh& mesh, const std::vector<std::string>& parts) {
    const Status status = checkClosedSolid(mesh, "organ.ply");
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().exitCode, exitBadInput);
    EXPECT_EQ(status.error().message.find("organ.ply: "), 0u) << status.error().message;
    EXPECT_EQ(status.error().message.find('\n'), std::string::npos) << status.error().message;
    EXPECT_NE(status.error().message.find(';'), std::string::npos) << "no hint: " << status.error().message;
    for (const auto& part : parts)
        EXPECT_NE(status.error().message.find(part), std::string::npos)
            << status.error().message << "\nlacks " << part;
}

void expectAccepted(const TriangleMesh& mesh) {
    const Status status = checkClosedSolid(mesh, "organ.ply");
    EXPECT_TRUE(status.ok()) << status.error().message;
}

TEST(MeshCheck, MeasuresABox) {
    const TriangleMesh mesh = moved(box({0, 0, 0}, {2, 3, 5}), {1e4, -2e4, 3e4});
    expectAccepted(mesh);
    const MeshReport report = inspectMesh(mesh, true);
    EXPECT_EQ(report.vertices, 8u);
    EXPECT_EQ(report.faces, 12u);
    EXPECT_DOUBLE_EQ(report.volume, 30);
    EXPECT_DOUBLE_EQ(report.area, 62);
    EXPECT_EQ(report.lowest, glm::dvec3(1e4, -2e4, 3e4));
    EXPECT_EQ(report.highest, glm::dvec3(10002, -19997, 30005));
    EXPECT_EQ(report.shells, 1u);
    EXPECT_EQ(report.solids, 1u);
    EXPECT_EQ(report.cavities, 0u);
    EXPECT_EQ(report.genus, std::vector<int>{0});
    EXPECT_EQ(report.openEdges + report.nonManifoldEdges + report.nonManifoldVertices +
                  report.inconsistentEdges + report.degenerateFaces + report.duplicateFaces +
                  report.unusedVertices,
              0u);
    EXPECT_EQ(report.selfIntersections, 0u);
}

TEST(MeshCheck, ATorusHasOneHandle) {
    const TriangleMesh mesh = torus(24, 3, 1);
    expectAccepted(mesh);
    EXPECT_EQ(inspectMesh(mesh, false).genus, std::vector<int>{1});
    EXPECT_NEAR(mesh.volume(), 2 * M_PI * M_PI * 3, 0.03 * mesh.volume());
    EXPECT_EQ(inspectMesh(mesh, true).selfIntersections, 0u);
    EXPECT_GT(inspectMesh(torus(24, 0.9, 1), true).selfIntersections, 0u); // a spindle torus crosses itself
}

TEST(MeshCheck, NormalsOfACubePointAway) {
    TriangleMesh mesh = cube(1);
    mesh.positions.push_back({5, 5, 5}); // unused
    const auto normals = mesh.vertexNormals();
    ASSERT_EQ(normals.size(), 9u);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_NEAR(glm::length(normals[i]), 1, 1e-15);
        EXPECT_GT(glm::dot(normals[i], glm::normalize(mesh.positions[i])), 0.8);
    }
    EXPECT_EQ(normals[8], glm::dvec3(0, 1, 0));
    EXPECT_EQ(TriangleMesh().lowest(), glm::dvec3(0));
    EXPECT_EQ(TriangleMesh().highest(), glm::dvec3(0));
}

TEST(MeshCheck, UnusedVerticesPass) {
    TriangleMesh mesh = cube(1);
    mesh.positions.insert(mesh.positions.begin(), {0, 0, 0});
    for (auto& face : mesh.faces)
        face += glm::uvec3(1);
    expectAccepted(mesh);
    EXPECT_EQ(inspectMesh(mesh, false).unusedVertices, 1u);
}

TEST(MeshCheck, RefusesNoFaces) {
    expectRefused({{{0, 0, 0}}, {}, {}, {}, {}}, {"no triangles"});
}

TEST(MeshCheck, RefusesAnOpenSurface) {
    TriangleMesh mesh = cube(1);
    mesh.faces.erase(mesh.faces.begin() + 3); // 4, 7, 6
    expectRefused(mesh,
                  {"open: 3 edges", "between vertices 4 and 6", "triangle 7", "near (", "fill the holes"});
    const MeshReport report = inspectMesh(mesh, false);
    EXPECT_EQ(report.openEdges, 3u);
    EXPECT_TRUE(report.genus.empty());
}

TEST(MeshCheck, RefusesANonManifoldEdge) {
    TriangleMesh mesh = cube(1);
    mesh.positions.push_back({0, 0, 9});
    mesh.faces.push_back({0, 1, 8});
    expectRefused(mesh, {"1 non-manifold edge ", "between vertices 1 and 0", "more than two triangles"});
    EXPECT_EQ(inspectMesh(mesh, false).nonManifoldEdges, 1u);
}

TEST(MeshCheck, RefusesAPinchedVertex) {
    // Two tetrahedra that share their corner at the origin.
    TriangleMesh mesh = joined(tetrahedron(), inverted(scaled(tetrahedron(), -1)));
    for (auto& face : mesh.faces)
        for (int corner = 0; corner < 3; ++corner)
            if (face[corner] == 4)
                face[corner] = 0;
    expectRefused(mesh, {"1 non-manifold vert", "vertex 0 ", "pinch"});
    EXPECT_EQ(inspectMesh(mesh, false).nonManifoldVertices, 1u);
}

TEST(MeshCheck, RefusesDoubledTriangles) {
    TriangleMesh mesh = cube(1);
    mesh.faces.push_back({7, 4, 5});
    expectRefused(mesh, {"1 triangle with the same three vertices", "triangle 12"});
    EXPECT_EQ(inspectMesh(mesh, false).duplicateFaces, 1u);
}

TEST(MeshCheck, RefusesInvertedSurfaces) {
    expectRefused(inverted(cube(1)), {"inverted", "flip all faces"});
    expectRefused(inverted(joined(cube(2), inverted(cube(1)))), {"inverted", "flip all faces"});
}

TEST(MeshCheck, RefusesInconsistentWinding) {
    TriangleMesh mesh = cube(1);
    std::swap(mesh.faces[5].x, mesh.faces[5].y);
    expectRefused(mesh, {"inconsistent winding: 3 edges", "make the normals consistent"});
    EXPECT_EQ(inspectMesh(mesh, false).inconsistentEdges, 3u);
}

TEST(MeshCheck, RefusesDegenerateTriangles) {
    TriangleMesh repeated = cube(1);
    repeated.faces.push_back({3, 3, 5});
    expectRefused(repeated, {"1 degenerate triangle ", "triangle 12 (from 0) of vertices 3, 3, 5"});
    EXPECT_EQ(inspectMesh(repeated, false).degenerateFaces, 1u);
    EXPECT_EQ(inspectMesh(repeated, false).shells, 1u);

    TriangleMesh flat = tetrahedron(); // a fourth point on the middle of an edge: 0, 4, 1 lie on a line
    flat.positions.push_back({0.5, 0, 0});
    flat.faces = {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {0, 1, 4}, {0, 3, 2}, {1, 2, 3}};
    expectRefused(flat, {"triangle 3 (from 0) of vertices 0, 1, 4"});
}

TEST(MeshCheck, TinyButTrueTrianglesPass) {
    // Edges of 9e-5 mm beside edges of 3 mm, 1,500 mm from the origin, as in real segmentations.
    TriangleMesh mesh = tetrahedron();
    mesh.positions.push_back({0.5, 9e-5 / 3, 0});
    mesh.faces = {{0, 2, 4}, {4, 2, 1}, {0, 4, 3}, {4, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    expectAccepted(moved(scaled(mesh, 3), glm::dvec3(1500)));
}

TEST(MeshCheck, RefusesAbsurdSizes) {
    expectRefused(scaled(cube(1), 1e20), {"absurd size", "2e+20", "length_unit"});
    expectRefused(scaled(cube(1), 1e300), {"absurd size", "length_unit"});
    expectRefused(scaled(cube(1), 1e-12), {"absurd size", "below 1e-9", "length_unit"});
    expectRefused(moved(cube(1e6), {1e12, 0, 0}), {"absurd place", "length_unit"});
    expectAccepted(scaled(cube(1), 4e8));
    expectAccepted(scaled(cube(1), 1e-8));
}

TEST(MeshCheck, RefusesWhatIsNotFinite) {
    TriangleMesh mesh = cube(1);
    mesh.positions[3].y = std::numeric_limits<double>::quiet_NaN();
    expectRefused(mesh, {"vertex 3 (from 0) is not finite"});
    (void)inspectMesh(mesh, true); // never fails
}

TEST(MeshCheck, RefusesAFlatFold) {
    // Two triangles back to back: closed, manifold edges, no inside; and a flattened cube.
    expectRefused({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}, {}, {}, {}},
                  {"same three vertices"});
    expectRefused({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.2, 0}}, tetrahedron().faces, {}, {}, {}},
                  {"no volume"});
}

TEST(MeshCheck, CavitiesPassAtAnyPlace) {
    const TriangleMesh hollow = joined(cube(5), inverted(cube(1)));
    expectAccepted(hollow);
    const MeshReport report = inspectMesh(hollow, false);
    EXPECT_EQ(report.shells, 2u);
    EXPECT_EQ(report.solids, 1u);
    EXPECT_EQ(report.cavities, 1u);
    EXPECT_EQ(report.genus, (std::vector<int>{0, 0}));
    EXPECT_DOUBLE_EQ(report.volume, 1000 - 8);

    // The cavity first in the file; two cavities; one whose vertices all lie on a grid line through edges of
    // the other.
    expectAccepted(joined(inverted(cube(1)), cube(5)));
    expectAccepted(
        joined(joined(cube(5), moved(inverted(cube(1)), {2, 2, 2})), moved(inverted(cube(1)), {-2, -2, -2})));
    // A cavity in the ring of a torus, though its middle is outside.
    expectAccepted(joined(torus(32, 6, 2), moved(inverted(cube(0.5)), {6, 0, 0})));
}

TEST(MeshCheck, RefusesSeveralSolids) {
    const TriangleMesh apart = joined(cube(1), moved(cube(2), {10, 0, 0}));
    expectRefused(apart, {"several solids", "shell 0 (12 triangles", "one solid a file"});
    EXPECT_EQ(inspectMesh(apart, false).solids, 2u);
    // In the hole of a torus, and in a concave corner: inside the other's box, outside of its surface.
    expectRefused(joined(torus(32, 6, 2), cube(0.5)), {"several solids", "shell 1"});
    // Afloat in a cavity.
    expectRefused(joined(joined(cube(5), inverted(cube(3))), cube(1)),
                  {"several solids", "floats in a cavity"});
    // Several thousand crumbs stay quick.
    TriangleMesh crumbs = cube(0.4);
    for (int i = 1; i < 1000; ++i)
        crumbs = joined(std::move(crumbs), moved(tetrahedron(), {2.0 * i, 0, 0}));
    expectRefused(crumbs, {"several solids"});
}

TEST(MeshCheck, RefusesWronglyNestedShells) {
    expectRefused(joined(cube(5), cube(1)),
                  {"overlapping solids", "shell 1", "flip its faces if it is a cavity"});
    expectRefused(joined(cube(5), moved(inverted(cube(1)), {20, 0, 0})),
                  {"shell 1", "is inverted", "no solid whose cavity"});
}

TEST(MeshCrossings, CountsPairsThatMeet) {
    // A needle through a plate: its three sides cross the two triangles of the plate's lower and upper face.
    const TriangleMesh plate = box({-10, -10, -1}, {10, 10, 1});
    const TriangleMesh needle{
        {{1, 2, -5}, {1.5, 2, -5}, {1, 2.5, -5}, {1.1, 2.1, 5}}, tetrahedron().faces, {}, {}, {}};
    EXPECT_EQ(countCrossings(joined(plate, needle)), 6u); // the needle stays on one side of both diagonals
    EXPECT_EQ(countCrossings(joined(plate, moved(needle, {20, 0, 0}))), 0u);
    EXPECT_EQ(countCrossings(joined(plate, moved(scaled(needle, 0.1), {0, 0, 1.6}))), 0u);
}

TEST(MeshCrossings, NeighboursCountOnlyBeyondWhatTheyShare) {
    // A fan of two triangles that share one corner, and one of them pierced by the other's far side.
    EXPECT_EQ(
        countCrossings(
            {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 1}, {-1, 1, 1}}, {{0, 1, 2}, {0, 3, 4}}, {}, {}, {}}),
        0u);
    EXPECT_EQ(
        countCrossings(
            {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {1, 1, -1}}, {{0, 1, 2}, {0, 3, 4}}, {}, {}, {}}),
        1u);
    // A shared edge: a hinge, flat, and folded onto itself.
    const auto hinge = [](glm::dvec3 tip) {
        return countCrossings({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, tip}, {{0, 1, 2}, {1, 0, 3}}, {}, {}, {}});
    };
    EXPECT_EQ(hinge({0, 1, 0.001}), 0u);
    EXPECT_EQ(hinge({0, -1, 0}), 0u);
    EXPECT_EQ(hinge({0.3, 0.5, 0}), 1u);
}

TEST(MeshCrossings, TouchingAndFlatTrianglesMeet) {
    const glm::dvec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
    EXPECT_TRUE(trianglesMeet(a, b, c, {1, 1, 0}, {1, 1, 5}, {2, 1, 5}));       // a corner on the face
    EXPECT_TRUE(trianglesMeet(a, b, c, {1, 1, 0}, {1.5, 1, 0}, {1, 1.5, 0}));   // inside, in the same plane
    EXPECT_TRUE(trianglesMeet(a, b, c, {-1, 1, 0}, {9, 1, 0}, {9, 1.5, 0}));    // across, in the same plane
    EXPECT_FALSE(trianglesMeet(a, b, c, {5, 5, 0}, {6, 5, 0}, {5, 6, 0}));      // beside, in the same plane
    EXPECT_FALSE(trianglesMeet(a, b, c, {1, 1, 1e-300}, {1, 1, 5}, {2, 1, 5})); // a hair above
    EXPECT_FALSE(trianglesMeet(a, b, c, {1, 1, -1}, {1, 1, 1}, {1, 1, 2}));     // no area
    // Far from the origin, where float64 alone cannot tell: one unit in the last place above and below the
    // plane.
    const double high = std::nextafter(1e6, 2e6), low = std::nextafter(1e6, 0.0);
    const glm::dvec3 o(1e6, 1e6, 1e6);
    EXPECT_FALSE(trianglesMeet(a + o, b + o, c + o, {1e6 + 1, 1e6 + 1, high}, {1e6 + 1, 1e6 + 2, high},
                               {1e6 + 2, 1e6 + 1, 1e6 + 9}));
    EXPECT_TRUE(trianglesMeet(a + o, b + o, c + o, {1e6 + 1, 1e6 + 1, low}, {1e6 + 1, 1e6 + 2, high},
                              {1e6 + 2, 1e6 + 1, 1e6 + 9}));
}

} // namespace
} // namespace serosa::sim
