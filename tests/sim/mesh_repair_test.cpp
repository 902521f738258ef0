// Faults are put into good surfaces, one kind at a time and together, and mended: what comes out is a closed
// solid of about the same volume whose other faces and vertices stand as they did. What repair does not name
// is refused.
#include "sim/mesh_check.h"
#include "sim/mesh_crossings.h"
#include "sim/mesh_repair.h"
#include "sim/mesh_winding.h"
#include "tests/sim/mesh_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>

namespace serosa::sim {
namespace {

/// A sphere of `n` rings of 2n, wound outward; no vertex has a coordinate that another one shares by chance.
TriangleMesh ball(std::uint32_t n, double radius) {
    TriangleMesh mesh;
    mesh.positions.push_back({0, radius, 0});
    for (std::uint32_t i = 1; i < n; ++i)
        for (std::uint32_t j = 0; j < 2 * n; ++j) {
            const double theta = M_PI * i / n, phi = M_PI * j / n + 0.1;
            mesh.positions.push_back({radius * std::sin(theta) * std::cos(phi), radius * std::cos(theta),
                                      -radius * std::sin(theta) * std::sin(phi)});
        }
    mesh.positions.push_back({0, -radius, 0});
    const auto at = [n](std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * 2 * n + j % (2 * n); };
    const auto south = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    for (std::uint32_t j = 0; j < 2 * n; ++j) {
        mesh.faces.push_back({0, at(1, j), at(1, j + 1)});
        for (std::uint32_t i = 1; i + 1 < n; ++i) {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
        mesh.faces.push_back({at(n - 1, j), south, at(n - 1, j + 1)});
    }
    return mesh;
}

/// Good surfaces: one solid, a handle, a cavity, far from the origin, coloured.
std::map<std::string, TriangleMesh> family() {
    TriangleMesh coloured = ball(16, 2);
    for (std::size_t i = 0; i < coloured.positions.size(); ++i)
        coloured.colours.push_back({i % 256, 7, 255 - i % 256});
    return {{"ball", ball(16, 1)},
            {"torus", torus(24, 3, 1)},
            {"hollow", joined(ball(16, 2), inverted(ball(9, 1)))},
            {"hollow torus", joined(torus(24, 3, 1), inverted(torus(20, 3, 0.5)))},
            {"far", moved(torus(20, 3, 1), {1e4, -2e4, 5e3})},
            {"coloured", coloured}};
}

class MeshRepair : public testing::Test {
protected:
    void SetUp() override {
        for (const auto& [name, mesh] : family())
            ASSERT_TRUE(checkClosedSolid(mesh, name).ok()) << checkClosedSolid(mesh, name).error().message;
    }

    /// The faulty mesh is refused as it is; mended, it is a closed solid without self-contact, whose faces
    /// and vertices are the good ones' but for what the fault took.
    RepairedMesh mend(const TriangleMesh& faulty, const TriangleMesh& good) {
        EXPECT_EQ(checkClosedSolid(faulty, "m").ok(), countStray(faulty) > 0);
        auto mended = repairMesh(faulty, "m");
        if (!mended.ok()) {
            ADD_FAILURE() << mended.error().message;
            return {good, {}};
        }
        EXPECT_TRUE(mended->report.changed());
        EXPECT_TRUE(checkClosedSolid(mended->mesh, "m").ok());
        EXPECT_EQ(countCrossings(mended->mesh), 0u);
        EXPECT_NEAR(mended->mesh.volume(), good.volume(), 0.02 * good.volume());
        const auto topology = inspectMesh(mended->mesh, false), before = inspectMesh(good, false);
        EXPECT_EQ(topology.genus, before.genus);
        EXPECT_EQ(topology.shells, before.shells);
        EXPECT_EQ(topology.cavities, before.cavities);
        EXPECT_EQ(topology.unusedVertices, 0u);
        return std::move(*mended);
    }
    static std::size_t countStray(const TriangleMesh& mesh) {
        return checkClosedSolid(mesh, "m").ok() ? inspectMesh(mesh, false).unusedVertices : 0;
    }
    static void expectSame(const TriangleMesh& a, const TriangleMesh& b) {
        EXPECT_EQ(a.positions, b.positions);
        EXPECT_EQ(a.faces, b.faces);
        EXPECT_EQ(a.colours, b.colours);
    }
    static void expectRefused(const TriangleMesh& mesh, const std::string& why) {
        const auto mended = repairMesh(mesh, "organ.ply");
        ASSERT_FALSE(mended.ok()) << "mended; expected: " << why;
        const std::string& message = mended.error().message;
        EXPECT_EQ(message.find("organ.ply: "), 0u) << message;
        EXPECT_NE(message.find("beyond --repair"), std::string::npos) << message;
        EXPECT_NE(message.find(why), std::string::npos) << message << "\nlacks " << why;
        EXPECT_NE(message.find(';'), std::string::npos) << "no hint: " << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_EQ(mended.error().exitCode, exitBadInput);
        const Status solid = checkClosedSolid(mesh, "organ.ply");
        ASSERT_FALSE(solid.ok());
        EXPECT_EQ(withRepairHint(solid.error(), mesh).message, solid.error().message);
    }
    static void expectHint(const TriangleMesh& mesh) {
        const Status solid = checkClosedSolid(mesh, "m");
        ASSERT_FALSE(solid.ok());
        EXPECT_NE(withRepairHint(solid.error(), mesh).message.find("--repair"), std::string::npos);
    }
};

TEST_F(MeshRepair, AGoodSurfaceComesOutUnchanged) {
    auto shapes = family();
    shapes.emplace("box", box({0, 0, 0}, {2, 3, 5}));
    shapes.emplace("tetrahedron", tetrahedron());
    for (const auto& [name, good] : shapes) {
        const auto mended = repairMesh(good, name);
        ASSERT_TRUE(mended.ok()) << mended.error().message;
        EXPECT_FALSE(mended->report.changed()) << name;
        EXPECT_TRUE(mended->report.lines().empty());
        expectSame(mended->mesh, good);
    }
}

TEST_F(MeshRepair, RemovesFacesWithARepeatedCorner) {
    for (const auto& [name, good] : family()) {
        SCOPED_TRACE(name);
        TriangleMesh faulty = good;
        faulty.faces.insert(faulty.faces.begin() + 7, {3, 3, 9});
        faulty.faces.push_back({5, 1, 5});
        faulty.faces.push_back({4, 4, 4});
        expectHint(faulty);
        const RepairedMesh mended = mend(faulty, good);
        EXPECT_EQ(mended.report.repeatedCornerFaces, 3u);
        EXPECT_EQ(mended.report.lines(), std::vector<std::string>{"removed 3 faces with a repeated corner"});
        expectSame(mended.mesh, good);
    }
}

TEST_F(MeshRepair, RemovesDuplicateFaces) {
    for (const auto& [name, good] : family()) {
        SCOPED_TRACE(name);
        TriangleMesh faulty = good;
        const glm::uvec3 a = good.faces[3], b = good.faces[40];
        faulty.faces.push_back(a);
        faulty.faces.push_back({a.y, a.z, a.x}); // turned
        faulty.faces.push_back({b.x, b.z, b.y}); // the other way round
        expectHint(faulty);
        const RepairedMesh mended = mend(faulty, good);
        EXPECT_EQ(mended.report.duplicateFaces, 3u);
        EXPECT_EQ(mended.report.flippedFaces, 0u);
        expectSame(mended.mesh, good);
    }
}

TEST_F(MeshRepair, FlipsSingleFaces) {
    for (const auto& [name, good] : family()) {
        SCOPED_TRACE(name);
        TriangleMesh faulty = good;
        for (const std::size_t face : {0, 1, 2, 50, 77})
            std::swap(faulty.faces[face].y, faulty.faces[face].z);
        expectHint(faulty);
        const RepairedMesh mended = mend(faulty, good);
        EXPECT_EQ(mended.report.flippedFaces, 5u);
        EXPECT_EQ(mended.report.turnedShells, 0u);
        expectSame(mended.mesh, good);
    }
}

TEST_F(MeshRepair, TurnsInvertedShells) {
    for (const auto& [name, good] : family()) {
        SCOPED_TRACE(name);
        TriangleMesh faulty = inverted(good);
        for (const std::size_t face : {0, 9}) // most faces are wrong, these are not
            std::swap(faulty.faces[face].y, faulty.faces[face].z);
        expectHint(faulty);
        const RepairedMesh mended = mend(faulty, good);
        EXPECT_EQ(mended.report.flippedFaces, good.faces.size() - 2);
        EXPECT_EQ(mended.report.turnedShells, inspectMesh(good, false).shells);
        expectSame(mended.mesh, good);
    }
}

TEST_F(MeshRepair, TurnsACavityInward) {
    const TriangleMesh outer = ball(12, 2), inner = ball(9, 1);
    const TriangleMesh good = joined(outer, inverted(inner));
    const RepairedMesh mended = mend(joined(outer, inner), good);
    EXPECT_EQ(mended.report.turnedShells, 1u);
    EXPECT_EQ(mended.report.flippedFaces, inner.faces.size());
    expectSame(mended.mesh, good);
}

TEST_F(MeshRepair, RemovesStrayVertices) {
    for (const auto& [name, good] : family()) {
        SCOPED_TRACE(name);
        TriangleMesh faulty = good;
        faulty.positions.insert(faulty.positions.begin() + 5, glm::dvec3(0.25));
        for (glm::uvec3& face : faulty.faces)
            for (int corner = 0; corner < 3; ++corner)
                face[corner] += face[corner] >= 5;
        if (!faulty.colours.empty())
            faulty.colours.insert(faulty.colours.begin() + 5, {1, 2, 3});
        const RepairedMesh mended = mend(faulty, good);
        EXPECT_EQ(mended.report.strayVertices, 1u);
        expectSame(mended.mesh, good);
    }
}

/// Removes the faces and says which are left, in order.
std::vector<glm::uvec3> without(const TriangleMesh& mesh, const std::set<std::size_t>& faces) {
    std::vector<glm::uvec3> left;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        if (!faces.contains(face))
            left.push_back(mesh.faces[face]);
    return left;
}

TEST_F(MeshRepair, FillsSmallHoles) {
    for (const auto& [name, good] : family()) {
        SCOPED_TRACE(name);
        // One face; two that share an edge; two that share a vertex only, where their holes touch.
        const glm::uvec3 first = good.faces[40];
        std::size_t touching = 0;
        for (std::size_t face = 0; face < good.faces.size() && touching == 0; ++face) {
            int shared = 0;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    shared += good.faces[face][i] == first[j];
            if (shared == 1)
                touching = face;
        }
        for (const std::set<std::size_t>& holes :
             {std::set<std::size_t>{40}, std::set<std::size_t>{40, touching},
              std::set<std::size_t>{4, 5, 90}}) {
            TriangleMesh faulty = good;
            faulty.faces = without(good, holes);
            const std::vector<glm::uvec3> left = faulty.faces;
            expectHint(faulty);
            const RepairedMesh mended = mend(faulty, good);
            EXPECT_EQ(mended.mesh.positions, good.positions);
            EXPECT_EQ(mended.report.addedFaces, holes.size());
            EXPECT_EQ(mended.report.addedVertices, 0u);
            EXPECT_TRUE(std::equal(left.begin(), left.end(), mended.mesh.faces.begin()))
                << "a face was touched";
            EXPECT_EQ(mended.report.flippedFaces, 0u);
        }
    }
}

// All faces around a vertex are gone, and the vertex with them; around three vertices in a row, too.
TEST_F(MeshRepair, FillsTheHoleOfAVertex) {
    for (const auto& [name, good] : family())
        for (const std::uint32_t count : {1u, 3u}) {
            SCOPED_TRACE(name + " " + std::to_string(count));
            const std::uint32_t vertex = 30;
            std::set<std::size_t> around;
            for (std::size_t face = 0; face < good.faces.size(); ++face)
                for (int corner = 0; corner < 3; ++corner)
                    if (good.faces[face][corner] >= vertex && good.faces[face][corner] < vertex + count)
                        around.insert(face);
            TriangleMesh faulty = good;
            faulty.faces = without(good, around);
            expectHint(faulty);
            const RepairedMesh mended = mend(faulty, good);
            EXPECT_EQ(mended.report.filledHoles, 1u);
            EXPECT_EQ(mended.report.strayVertices, count);
            EXPECT_EQ(mended.report.addedFaces, around.size() - 2 * count);
        }
}

// The flat side of a box with a hole that is not convex: the filling is flat, so the volume comes back.
TEST_F(MeshRepair, FillsAFlatHoleFlat) {
    TriangleMesh mesh;
    constexpr std::uint32_t n = 16; // a plate n by n, one thick
    for (std::uint32_t z = 0; z < 2; ++z)
        for (std::uint32_t j = 0; j <= n; ++j)
            for (std::uint32_t i = 0; i <= n; ++i)
                mesh.positions.push_back({i, j, z});
    const auto at = [](std::uint32_t i, std::uint32_t j, std::uint32_t z) {
        return z * (n + 1) * (n + 1) + j * (n + 1) + i;
    };
    const auto quad = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
    };
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            quad(at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1));
            quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
        }
        quad(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1));
        quad(at(i + 1, n, 0), at(i, n, 0), at(i, n, 1), at(i + 1, n, 1));
        quad(at(0, i + 1, 0), at(0, i, 0), at(0, i, 1), at(0, i + 1, 1));
        quad(at(n, i, 0), at(n, i + 1, 0), at(n, i + 1, 1), at(n, i, 1));
    }
    ASSERT_TRUE(checkClosedSolid(mesh, "plate").ok()) << checkClosedSolid(mesh, "plate").error().message;
    // An L of three quads on the upper side.
    std::set<std::size_t> gone;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        glm::dvec3 sum(0);
        for (int corner = 0; corner < 3; ++corner)
            sum += mesh.positions[mesh.faces[face][corner]] / 3.0;
        if (sum.z == 1 && sum.x > 5 && sum.y > 5 && sum.x < 7 && sum.y < 7 && !(sum.x > 6 && sum.y > 6))
            gone.insert(face);
    }
    ASSERT_EQ(gone.size(), 6u);
    TriangleMesh faulty = mesh;
    faulty.faces = without(mesh, gone);
    const RepairedMesh mended = mend(faulty, mesh);
    EXPECT_EQ(mended.report.addedFaces, 6u);
    EXPECT_NEAR(mended.mesh.volume(), n * n, 1e-9);
    EXPECT_NEAR(mended.mesh.area(), mesh.area(), 1e-9);
}

TEST_F(MeshRepair, MendsAllAtOnceAndSaysSo) {
    const TriangleMesh good = torus(24, 3, 1);
    TriangleMesh faulty = inverted(good);
    faulty.faces.erase(faulty.faces.begin() + 100);
    std::swap(faulty.faces[7].y, faulty.faces[7].z);
    faulty.faces.push_back(faulty.faces[200]);
    faulty.faces.push_back({1, 2, 1});
    faulty.positions.push_back({9, 9, 9});
    const RepairedMesh mended = mend(faulty, good);
    EXPECT_EQ(
        mended.report.lines(),
        (std::vector<std::string>{"removed 1 face with a repeated corner", "removed 1 duplicate face",
                                  "flipped 1150 faces that wound wrongly (1 shell turned as a whole)",
                                  "filled 1 hole with 1 face", "removed 1 stray vertex that no face used"}));
    EXPECT_EQ(mended.mesh.positions, good.positions);
}

// Any mix of faults is mended or refused; what was mended is whole, holds no new crossing, and needs no more.
TEST_F(MeshRepair, MendsOrRefusesRandomFaults) {
    std::mt19937 random(17);
    const auto below = [&random](std::size_t limit) { return random() % limit; };
    int mendings = 0, refusals = 0;
    for (const auto& [name, good] : family())
        for (int run = 0; run < 60; ++run) {
            TriangleMesh faulty = good;
            for (std::size_t faults = 1 + below(12); faults > 0; --faults) {
                const std::size_t face = below(faulty.faces.size());
                const glm::uvec3 t = faulty.faces[face];
                const std::size_t kind = below(run % 4 == 0 ? 6 : 5); // the sixth cannot be mended
                if (kind == 0)
                    faulty.faces.erase(faulty.faces.begin() + std::ptrdiff_t(face));
                else if (kind == 1)
                    faulty.faces[face] = {t.x, t.z, t.y};
                else if (kind == 2)
                    faulty.faces.insert(faulty.faces.begin() + std::ptrdiff_t(face / 2), {t.y, t.z, t.x});
                else if (kind == 3)
                    faulty.faces.push_back({t.x, t.x, t.y});
                else if (kind == 4)
                    faulty.positions.push_back(faulty.positions[t.x] * 1.5);
                else
                    faulty.faces[face].x = std::uint32_t(below(good.positions.size()));
            }
            if (!faulty.colours.empty())
                faulty.colours.resize(faulty.positions.size());
            const auto mended = repairMesh(faulty, "m");
            if (!mended.ok()) {
                ++refusals;
                EXPECT_EQ(mended.error().message.find("m: "), 0u);
                continue;
            }
            ++mendings;
            EXPECT_TRUE(checkClosedSolid(mended->mesh, "m").ok());
            EXPECT_EQ(mended->mesh.colours.size(), good.colours.empty() ? 0 : mended->mesh.positions.size());
            EXPECT_NEAR(mended->mesh.volume(), good.volume(), 0.05 * good.volume()) << name << " " << run;
            const auto again = repairMesh(mended->mesh, "m");
            ASSERT_TRUE(again.ok());
            EXPECT_FALSE(again->report.changed());
            expectSame(again->mesh, mended->mesh);
            if (run % 10 == 1) {
                EXPECT_EQ(countCrossings(mended->mesh), 0u) << name << " " << run;
            }
        }
    EXPECT_GT(mendings, 200);
    EXPECT_GT(refusals, 20);
}

TEST_F(MeshRepair, RefusesLargeHoles) {
    TriangleMesh open = ball(12, 1); // half of it
    std::erase_if(open.faces, [&](const glm::uvec3& face) {
        return open.positions[face.x].y + open.positions[face.y].y + open.positions[face.z].y > 0.3;
    });
    expectRefused(open, "a hole of 48 edges");
    const TriangleMesh good = ball(12, 1);
    TriangleMesh faulty = good;
    faulty.faces = without(good, {40});
    EXPECT_TRUE(repairMesh(faulty, "m", {3, 0.2}).ok());
    EXPECT_FALSE(repairMesh(faulty, "m", {2, 0.2}).ok()) << "the edge limit was passed over";
    EXPECT_FALSE(repairMesh(faulty, "m", {3, 0.01}).ok()) << "the limit of extent was passed over";
    open.positions.push_back({500, 0, 0}); // a stray vertex far away makes no hole small
    EXPECT_FALSE(repairMesh(open, "m").ok());
}

TEST_F(MeshRepair, RefusesWhatItDoesNotName) {
    TriangleMesh fin = cube(1);
    fin.positions.push_back({0, 0, 9});
    fin.faces.push_back({0, 1, 8});
    expectRefused(fin, "1 non-manifold edge");

    TriangleMesh pinched = joined(tetrahedron(), inverted(scaled(tetrahedron(), -1)));
    for (auto& face : pinched.faces)
        for (int corner = 0; corner < 3; ++corner)
            if (face[corner] == 4)
                face[corner] = 0;
    expectRefused(pinched, "1 non-manifold vertex");

    expectRefused(joined(cube(1), moved(cube(1), {5, 0, 0})), "several solids");
    expectRefused(joined(joined(cube(3), inverted(cube(2))), cube(1)), "several solids");
    expectRefused(scaled(cube(1), 1e20), "absurd size");
    expectRefused({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 1}}, {}, {}, {}}, "repeated corner");

    TriangleMesh sliver = cube(1); // a vertex in the middle of an edge makes a face without area
    const glm::uvec3 cut = sliver.faces[0];
    sliver.positions.push_back((sliver.positions[cut.x] + sliver.positions[cut.y]) / 2.0);
    sliver.faces[0] = {8, cut.y, cut.z};
    sliver.faces.push_back({cut.x, 8, cut.z});
    sliver.faces.push_back({cut.x, cut.y, 8});
    expectRefused(sliver, "zero-area face");

    TriangleMesh strip; // a Moebius strip of seven quads
    for (int i = 0; i < 7; ++i) {
        const double turn = 2 * M_PI * i / 7;
        for (const double side : {-1.0, 1.0})
            strip.positions.push_back({(5 + side * std::cos(turn / 2)) * std::cos(turn),
                                       (5 + side * std::cos(turn / 2)) * std::sin(turn),
                                       side * std::sin(turn / 2)});
    }
    for (std::uint32_t i = 0; i < 7; ++i) {
        const std::uint32_t a = 2 * i, b = 2 * i + 1, c = i == 6 ? 1 : a + 2, d = i == 6 ? 0 : b + 2;
        strip.faces.push_back({a, c, b});
        strip.faces.push_back({b, c, d});
    }
    expectRefused(strip, "one-sided");
}

// A seam of doubled vertices is a hole without area: it is to be welded, not filled.
TEST_F(MeshRepair, RefusesASeam) {
    constexpr std::uint32_t n = 24, i = 7, j = 9;
    TriangleMesh seam = torus(n, 3, 1); // split along two edges in a row: the vertex between gets a twin
    const auto twin = static_cast<std::uint32_t>(seam.positions.size());
    seam.positions.push_back(seam.positions[i * n + j]);
    for (const std::uint32_t face : {2 * (i * n + j), 2 * (i * n + j) + 1, 2 * (i * n + j - 1) + 1})
        for (int corner = 0; corner < 3; ++corner)
            if (seam.faces[face][corner] == i * n + j)
                seam.faces[face][corner] = twin;
    EXPECT_EQ(inspectMesh(seam, false).openEdges, 4u);
    expectRefused(seam, "without touching");
}

TEST_F(MeshRepair, RefusesALoneTriangle) {
    expectRefused({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}, {}}, "a hole of 3 edges");
    TriangleMesh island = joined(cube(100), moved(scaled(tetrahedron(), 1), {200, 0, 0}));
    island.faces.resize(13); // the cube and one face of the tetrahedron
    expectRefused(island, "without touching");
}

TEST(MeshWinding, LoopsRunAsTheFillingWinds) {
    TriangleMesh mesh = ball(12, 1);
    const glm::uvec3 gone = mesh.faces[40];
    mesh.faces.erase(mesh.faces.begin() + 40);
    const auto loops = boundaryLoops(mesh, "m");
    ASSERT_TRUE(loops.ok());
    ASSERT_EQ(loops->size(), 1u);
    BoundaryLoop expected{gone.x, gone.y, gone.z};
    std::rotate(expected.begin(), std::min_element(expected.begin(), expected.end()), expected.end());
    EXPECT_EQ(loops->front(), expected);
}

} // namespace
} // namespace serosa::sim
