// Legacy VTK and TetGen surfaces: what is accepted, on files spelled out by hand and on real organs, and each
// refusal with its line or byte.
#include "sim/mesh_check.h"
#include "sim/mesh_reader.h"
#include "sim/mesh_reader_detail.h"
#include "sim/mesh_repair.h"
#include "tests/sim/mesh_files.h"

#include <gtest/gtest.h>

namespace serosa::sim {
namespace {

class MeshReaderVtk : public MeshFiles {
protected:
    void expectTetrahedron(const std::filesystem::path& path, std::size_t unused = 0) {
        const auto mesh = readMesh(path);
        ASSERT_TRUE(mesh.ok()) << mesh.error().message;
        const TriangleMesh expected = tetrahedron();
        ASSERT_EQ(mesh->positions.size(), 4 + unused);
        EXPECT_TRUE(
            std::equal(expected.positions.begin(), expected.positions.end(), mesh->positions.begin()));
        EXPECT_EQ(mesh->faces, expected.faces);
        EXPECT_TRUE(checkClosedSolid(*mesh, "m").ok());
    }
    void expectRefused(const std::filesystem::path& path, const std::string& lead, const std::string& what) {
        const auto mesh = readMesh(path);
        ASSERT_FALSE(mesh.ok()) << path << " was read; expected: " << what;
        const std::string& message = mesh.error().message;
        EXPECT_EQ(message.find((folder_ / lead).string()), 0u) << message << "\nlacks " << lead;
        EXPECT_NE(message.find(what), std::string::npos) << message << "\nlacks " << what;
        EXPECT_NE(message.find(';'), std::string::npos) << "no hint: " << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    void refuseVtk(const std::string& bytes, const std::string& where, const std::string& what) {
        expectRefused(file("a.vtk", bytes), "a.vtk" + where, what);
    }
    /// Both files; the message leads with the one that is wrong.
    void refuseTetgen(const std::string& node, const std::string& face, const std::string& lead,
                      const std::string& what) {
        file("a.node", node);
        expectRefused(file("a.face", face), lead, what);
        expectRefused(folder_ / "a.node", lead, what);
    }
    static std::string replaced(std::string text, const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    }
};

TEST_F(MeshReaderVtk, ReadsEachEncoding) {
    expectTetrahedron(file("a.vtk", kVtkText));
    expectTetrahedron(file("b.vtk", vtkBinary()));
    expectTetrahedron(file("c.vtk", vtkOffsets(true)));
    expectTetrahedron(file("d.vtk", vtkOffsets(false)));
    expectTetrahedron(file("without_extension", kVtkText));
    expectTetrahedron(file("A.VTK", replaced(kVtkText, "POLYDATA", "polydata")));
    expectTetrahedron(file("crlf.vtk", replaced(kVtkText, "ASCII\n", "ASCII\r\n")));
    expectTetrahedron(file("attributes.vtk", kVtkText + "POINT_DATA 4\nSCALARS x float\nanything\n"));
    expectTetrahedron(file("empty_lines.vtk", replaced(kVtkText, "POLYGONS", "LINES 0 0\nPOLYGONS")));
}

TEST_F(MeshReaderVtk, FansPolygonsAndUnrollsStrips) {
    const std::string head =
        "# vtk DataFile Version 2.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n";
    const auto quad = readMesh(file("quad.vtk", head + "POLYGONS 1 5\n4 0 1 2 3\n"));
    ASSERT_TRUE(quad.ok());
    EXPECT_EQ(quad->faces, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
    const auto strip = readMesh(file("strip.vtk", head + "TRIANGLE_STRIPS 1 5\n4 0 1 3 2\n"));
    ASSERT_TRUE(strip.ok());
    EXPECT_EQ(strip->faces, (std::vector<glm::uvec3>{{0, 1, 3}, {1, 2, 3}}));
}

TEST_F(MeshReaderVtk, RefusesBadHeaders) {
    refuseVtk("# vtk DataFile\nversion\n", ":1: ", "wrong magic");
    refuseVtk(replaced(kVtkText, "3.0", "9.1"), ":1: ", "version '9.1'");
    refuseVtk(replaced(kVtkText, "ASCII", "TEXT"), ":3: ", "'TEXT' where ASCII or BINARY");
    refuseVtk(replaced(kVtkText, "DATASET", "DATA"), ":4: ", "where DATASET should stand");
    refuseVtk(replaced(kVtkText, "POLYDATA", "UNSTRUCTURED_GRID"), ":4: ", "not POLYDATA");
    refuseVtk(replaced(kVtkText, "POLYGONS", "POLYGON"), ":9: ", "unknown section 'POLYGON'");
    refuseVtk(replaced(kVtkText, "POLYGONS", "LINES"), ":9: ", "the file holds lines");
    refuseVtk(kVtkText.substr(0, kVtkText.find("POLYGONS")), ":", "no POLYGONS");
    refuseVtk("# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n", ":", "no POINTS");
    refuseVtk(kObj, ":1: ", "wrong magic");
    expectRefused(file("a.obj", kVtkText), "a.obj: byte 0: ", "the content is VTK, the name says OBJ");
    refuseVtk("", ": ", "empty (0 bytes)");
}

TEST_F(MeshReaderVtk, RefusesBadNumbers) {
    refuseVtk(replaced(kVtkText, "0 0 0 1", "nan 0 0 1"), ":6: ", "'nan' is not a finite number");
    refuseVtk(replaced(kVtkText, "0 0 0 1", "0,5 0 0 1"), ":6: ", "decimal points");
    refuseVtk(replaced(kVtkText, "0 0 0 1", "0 inf 0 1"), ":6: ", "not a finite number");
    refuseVtk(replaced(kVtkText, "3 0 2 1", "3 0 2 4"), ":10: ", "names point 4");
    refuseVtk(replaced(kVtkText, "3 0 2 1", "3 0 2 -1"), ":10: ", "names point -1");
    refuseVtk(replaced(kVtkText, "3 0 2 1", "2 0 2 1"), ":10: ", "face 0 has 2 corners");
    refuseVtk(replaced(kVtkText, "3 0 2 1", "99 0 2 1"), ":10: ", "announces 99 corners");
    refuseVtk(replaced(kVtkText, "4 16", "4 17"), ":", "17 were announced");
    refuseVtk(replaced(kVtkText, "4 16", "5 16"), ":13: ", "face 4 lies beyond the 16 numbers");
    refuseVtk(replaced(kVtkText, "4 16", "4 15"), ":13: ", "announces 3 corners");
    refuseVtk(replaced(kVtkText, "4 16", "3 16"), ":12: ", "the faces take 12 numbers");
    refuseVtk(replaced(kVtkText, "POINTS 4", "POINTS 0"), ":5: ", "no points");
    refuseVtk(replaced(kVtkText, "POINTS 4", "POINTS -4"), ":5: ", "outside of");
    refuseVtk(replaced(kVtkText, "POINTS 4", "POINTS 4000000000"), ":5: ", "more than the");
    refuseVtk(replaced(kVtkText, "POLYGONS 4 16", "POLYGONS 4 4000000000"), ":9: ", "more than the");
    refuseVtk(replaced(kVtkText, "POLYGONS", "POINTS 1 float 0 0 0 POLYGONS"), ":9: ", "a second POINTS");
    refuseVtk(kVtkText + "3 0 1 2\n", ":14: ", "unknown section '3'");
    const std::string binary = vtkBinary();
    const std::size_t points = binary.find("float\n") + 6;
    std::string bad = binary;
    bad.replace(points, 4, "\x7f\xc0\x00\x00", 4);
    refuseVtk(bad, ": byte " + std::to_string(points) + ": ", "not a finite number");
    bad = binary;
    bad[bad.find("POLYGONS 4 16\n") + 14 + 3] = 9;
    refuseVtk(bad, ": byte ", "face 2 announces 2 corners"); // the second took nine
    refuseVtk(replaced(binary, "4 float", "4 short"), ": byte ", "points of type 'short'");
    refuseVtk(replaced(vtkOffsets(false), "0 3 6 9 12", "0 6 3 9 12"), ":", "never fall");
    refuseVtk(replaced(vtkOffsets(false), "0 3 6 9 12", "0 3 6 9 11"), ":", "the last offset is 11");
    refuseVtk(replaced(vtkOffsets(false), "0 3 6 9 12", "1 3 6 9 12"), ":", "start at 0");
}

TEST_F(MeshReaderVtk, RefusesTruncations) {
    const auto refuseAll = [](const std::string& bytes, std::size_t whole) {
        for (std::size_t size = 0; size < whole; ++size) {
            const auto mesh =
                detail::readVtk(detail::MeshSource{"cut", std::string_view(bytes).substr(0, size)});
            ASSERT_FALSE(mesh.ok()) << "cut to " << size << " of " << whole << " bytes, it was read";
            EXPECT_EQ(mesh.error().message.find("cut:"), 0u) << mesh.error().message;
        }
    };
    refuseAll(kVtkText, kVtkText.size() - 1); // all but the last line end
    const std::string binary = vtkBinary();
    refuseAll(binary, binary.find("\nCELL_DATA"));
    refuseAll(vtkOffsets(true), vtkOffsets(true).size() - 1);
    refuseAll(vtkOffsets(false), vtkOffsets(false).size() - 2);
}

TEST_F(MeshReaderVtk, ReadsTetgenByEitherName) {
    file("a.node", kNode);
    expectTetrahedron(file("a.face", kFace), 1);
    expectTetrahedron(folder_ / "a.node", 1);
    std::string node = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1",
                face = "4 0\n0 0 2 1\n1 0 1 3\n2 0 3 2\n";
    file("zero.node", node);
    expectTetrahedron(file("zero.face", face + "3 1 2 3"));
    expectTetrahedron(file("zero.face", face + "3 1 2 3 -1 5")); // the tetrahedra on either side
    // Faces counted from 1 over nodes from 0, as some programs write them.
    expectTetrahedron(file("zero.face", "4 0\n1 0 2 1\n2 0 1 3\n3 0 3 2\n4 1 2 3\n"));
}

TEST_F(MeshReaderVtk, RefusesBadTetgenFiles) {
    expectRefused(file("lone.face", kFace), "lone.face: ", "lone.node is not beside it");
    expectRefused(file("only.node", kNode), "only.node: ", "only.face is not beside it");
    const std::string body = kNode.substr(kNode.find("5 3"));
    refuseTetgen("5 3 1\n" + body.substr(8), kFace, "a.node:1: ", "the header has 3 values");
    refuseTetgen(replaced(kNode, "5 3 1 1", "5 2 1 1"), kFace, "a.node:2: ", "'2' is outside of 3 .. 3");
    refuseTetgen(replaced(kNode, "5 3 1 1", "6 3 1 1"), kFace, "a.node:7: ", "after 5 of 6 nodes");
    refuseTetgen(replaced(kNode, "5 3 1 1", "4 3 1 1"), kFace,
                 "a.node:7: ", "text after the last of 4 nodes");
    refuseTetgen(replaced(kNode, "5 3 1 1", "4000000000 3 1 1"), kFace, "a.node:2: ", "more than the");
    refuseTetgen(replaced(kNode, "2 1 0 0 -1 1", "3 1 0 0 -1 1"), kFace,
                 "a.node:4: ", "node index 3 where 2");
    refuseTetgen(replaced(kNode, "1 0 0 0 0.5 1", "2 0 0 0 0.5 1"), kFace,
                 "a.node:3: ", "node index 2 where 0");
    refuseTetgen(replaced(kNode, "2 1 0 0 -1 1", "2 1 0 nan -1 1"), kFace,
                 "a.node:4: ", "not a finite number");
    refuseTetgen(replaced(kNode, "2 1 0 0 -1 1", "2 1 0,5 0 -1 1"), kFace, "a.node:4: ", "decimal points");
    refuseTetgen(replaced(kNode, "2 1 0 0 -1 1", "2 1 0 0 -1"), kFace, "a.node:4: ", "has 5 values, not 6");
    refuseTetgen(replaced(kNode, "2 1 0 0 -1 1", "2 1 0 0 x 1"), kFace, "a.node:4: ", "'x' is not a number");
    refuseTetgen(kNode, replaced(kFace, "4 1\n", "4\n"), "a.face:1: ", "the header has 1 values");
    refuseTetgen(kNode, replaced(kFace, "4 1\n", "0 1\n"), "a.face:1: ", "no faces");
    refuseTetgen(kNode, replaced(kFace, "4 1\n", "5 1\n"), "a.face:6: ", "after 4 of 5 faces");
    refuseTetgen(kNode, replaced(kFace, "4 1\n", "99999999 1\n"), "a.face:1: ", "more than the");
    refuseTetgen(kNode, replaced(kFace, "4 2 3 4 7", "4 2 3 6 7"), "a.face:5: ", "names node 6");
    refuseTetgen(kNode, replaced(kFace, "4 2 3 4 7", "4 2 3 0 7"), "a.face:5: ", "counted from 1 to 5");
    refuseTetgen(kNode, replaced(kFace, "4 2 3 4 7", "4 2 3 4"), "a.face:5: ", "has 4 values, not 5");
    refuseTetgen(kNode, replaced(kFace, "4 2 3 4 7", "4 2 3 4 7.5"), "a.face:5: ", "not a whole number");
    refuseTetgen(kNode, replaced(kFace, "2 1 2 4 -1", "5 1 2 4 -1"), "a.face:3: ", "face index 5 where 2");
    refuseTetgen(kNode, kFace + "5 1 2 3 0\n", "a.face:7: ", "text after the last of 4 faces");
    file("a.node", "");
    expectRefused(folder_ / "a.face", "a.node: ", "empty");
}

TEST_F(MeshReaderVtk, ReadsRealOrgans) {
    const char* data = std::getenv("SEROSA_DATA");
    if (data == nullptr)
        GTEST_SKIP() << "SEROSA_DATA is not set";
    const auto folder = std::filesystem::path(data) / "surfaces_other";
    const auto torso = readMesh(folder / "torso.vtk");
    ASSERT_TRUE(torso.ok()) << torso.error().message;
    EXPECT_EQ(torso->positions.size(), 15001u);
    EXPECT_EQ(torso->faces.size(), 29998u);
    EXPECT_TRUE(checkClosedSolid(*torso, "torso").ok());

    const auto heart = readMesh(folder / "heart_rabbit.face");
    ASSERT_TRUE(heart.ok()) << heart.error().message;
    EXPECT_EQ(heart->positions.size(), 63885u);
    EXPECT_EQ(heart->faces.size(), 41812u);
    const Status inward = checkClosedSolid(*heart, "heart");
    ASSERT_FALSE(inward.ok());
    EXPECT_NE(inward.error().message.find("inverted"), std::string::npos);
    EXPECT_NE(withRepairHint(inward.error(), *heart).message.find("--repair"), std::string::npos);
    const auto mended = repairMesh(*heart, "heart");
    ASSERT_TRUE(mended.ok()) << mended.error().message;
    EXPECT_EQ(mended->mesh.positions.size(), 20908u);
    EXPECT_EQ(mended->report.flippedFaces, 41812u);
    EXPECT_EQ(mended->report.strayVertices, 42977u);
    EXPECT_NEAR(mended->mesh.volume(), -heart->volume(), 1e-9);
}

} // namespace
} // namespace serosa::sim
