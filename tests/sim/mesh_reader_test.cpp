// What the readers accept, in each format: polygons, relative indices, extra properties, colours, byte
// orders. Each file is a tetrahedron spelled out here; the expected mesh is known by hand. Bad files:
// mesh_reader_errors_test.cpp.
#include "sim/mesh_check.h"
#include "sim/mesh_reader.h"
#include "tests/sim/mesh_files.h"
#include "tests/sim/mesh_shapes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace serosa::sim {
namespace {

class MeshReader : public MeshFiles {
protected:
    TriangleMesh read(const std::string& name, const std::string& bytes) {
        auto mesh = readMesh(file(name, bytes));
        EXPECT_TRUE(mesh.ok()) << mesh.error().message;
        return mesh.ok() ? *std::move(mesh) : TriangleMesh();
    }
    void expectTetrahedron(const TriangleMesh& mesh) {
        EXPECT_EQ(mesh.positions, tetrahedron().positions);
        EXPECT_EQ(mesh.faces, tetrahedron().faces);
    }
};

TEST_F(MeshReader, Obj) {
    expectTetrahedron(read("a.obj", kObj));
    expectTetrahedron(read("A.OBJ", kObj));
    std::string windows = kObj;
    for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
        windows.insert(at, "\r");
    expectTetrahedron(read("windows.obj", windows));
    EXPECT_TRUE(read("a.obj", kObj).colours.empty());
}

TEST_F(MeshReader, ObjWithAllThatIsPassedOver) {
    expectTetrahedron(
        read("a.obj",
             "# made by hand\nmtllib no_such_file.mtl\no organ\nvn 0 0 1\nvt 0.5 0.5\n"
             "v 0 0 0\nv +1 0 0 1.0\n\n  v\t0 1e0 0 # comment\nv 0 0 .1e1\ng left\ns off\n"
             "usemtl red\nl 1 2\np 3\nf 1//1 3//1 2//1\nf 1/1/1 2/1/1 4/1/1\nf 1/1 4/1 3/1\nf 2 3 \\\n4"));
}

TEST_F(MeshReader, ObjCountsBackFromTheLastVertex) {
    expectTetrahedron(
        read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -1 -2\nv 0 0 1\nf -4 -3 -1\nf -4 -1 -2\nf 2 3 4\n"));
    // An index may name a vertex that comes later.
    expectTetrahedron(
        read("b.obj", "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"));
}

TEST_F(MeshReader, ObjTextureCoordinates) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    const auto mesh = read("a.obj", vertices + "vt 0 0\nvt 1 0.5 0\nvt 0.25\nf 1/1 2/2/1 4/-1 3/1\n");
    const std::vector<glm::vec2> uvs{{0, 0}, {1, 0.5}, {0.25, 0}, {0, 0}, {0.25, 0}, {0, 0}};
    EXPECT_EQ(mesh.uvs, uvs); // three a face, of the fan
    EXPECT_TRUE(read("b.obj", vertices + "vt 0 0\nf 1/1 2/1 4/1\nf 1 4 3\n").uvs.empty());
}

TEST_F(MeshReader, PlyTextureCoordinates) {
    for (const char* names :
         {"property float s\nproperty float t\n", "property float texture_u\nproperty double texture_v\n"}) {
        const auto mesh =
            read("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                          "property float z\n" +
                              std::string(names) +
                              "element face 1\nproperty list uchar int vertex_index\nend_header\n"
                              "0 0 0 0.5 1\n1 0 0 0 0.25\n0 1 0 2 -1\n3 2 0 1\n");
        EXPECT_EQ(mesh.uvs, (std::vector<glm::vec2>{{2, -1}, {0.5, 1}, {0, 0.25}}));
    }
}

TEST_F(MeshReader, ObjColours) {
    const auto mesh = read("a.obj", "v 0 0 0 1 0 0.5\nv 1 0 0 0 0 0\nv 0 1 0 1 1 1\nf 1 2 3\n");
    ASSERT_EQ(mesh.colours.size(), 3u);
    EXPECT_EQ(mesh.colours[0], glm::u8vec3(255, 0, 128));
    EXPECT_EQ(mesh.colours[2], glm::u8vec3(255, 255, 255));
}

TEST_F(MeshReader, PolygonsAreFanned) {
    const std::vector<glm::uvec3> fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    const std::string vertices = "0 0 0\n2 0 0\n3 1 0\n2 2 0\n0 2 0\n";
    EXPECT_EQ(read("a.off", "OFF 5 1 0\n" + vertices + "5 0 1 2 3 4 0.1 0.2 0.3\n").faces, fan);
    EXPECT_EQ(
        read("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 1\nproperty list uchar int vertex_index\nend_header\n" +
                 vertices + "5 0 1 2 3 4\n")
            .faces,
        fan);
    EXPECT_EQ(read("a.obj", "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n").faces, fan);
}

TEST_F(MeshReader, Off) {
    expectTetrahedron(read("a.off", kOff));
    expectTetrahedron(read("no_extension", kOff));
    expectTetrahedron(read("a.off", "OFF # comment\n\n# more\n4 4 6\n\n0 0 0\n1 0 0 # x\n0 1 0\n0 0 1\n"
                                    "3 0 2 1 255 0 0\n3 0 1 3 1\n3 0 3 2\n3 1 2 3"));
}

TEST_F(MeshReader, OffColoursAndNormals) {
    const auto bytes =
        read("a.off", "COFF\n3 1 0\n0 0 0 255 0 128 255\n1 0 0 1 2 3 255\n0 1 0 0 0 0 255\n3 0 1 2\n");
    ASSERT_EQ(bytes.colours.size(), 3u);
    EXPECT_EQ(bytes.colours[0], glm::u8vec3(255, 0, 128));
    EXPECT_EQ(bytes.colours[1], glm::u8vec3(1, 2, 3));
    const auto shares = read(
        "a.off",
        "CNOFF\n3 1 0\n0 0 0 0 0 1 1.0 0.0 0.5\n1 0 0 0 0 1 0.2 0.2 0.2\n0 1 0 0 0 1 0. 0. 1.\n3 0 1 2\n");
    EXPECT_EQ(shares.colours[0], glm::u8vec3(255, 0, 128));
    EXPECT_EQ(shares.colours[2], glm::u8vec3(0, 0, 255));
    EXPECT_EQ(shares.positions[1], glm::dvec3(1, 0, 0));
    EXPECT_TRUE(
        read("a.off", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n").colours.empty());
    EXPECT_EQ(read("a.off",
                   "STCOFF\n3 1 0\n0 0 0 9 8 7 255 0 0\n1 0 0 9 8 7 255 0 0\n0 1 0 9 8 7 255 0 0\n3 0 1 2\n")
                  .colours[0],
              glm::u8vec3(9, 8, 7));
}

TEST_F(MeshReader, PlyText) {
    expectTetrahedron(read("a.ply", kPlyText));
    expectTetrahedron(read("a", kPlyText));
}

TEST_F(MeshReader, PlyBinaryOfBothByteOrders) {
    expectTetrahedron(read("little.ply", plyBinary(true)));
    expectTetrahedron(read("big.ply", plyBinary(false)));
    expectTetrahedron(read("little.ply", plyBinaryWithExtras(true)));
    expectTetrahedron(read("big.ply", plyBinaryWithExtras(false)));
}

TEST_F(MeshReader, PlyWithExtraElementsListsAndTypes) {
    expectTetrahedron(
        read("a.ply",
             "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info more\r\nelement camera 1\r\n"
             "property float focus\r\nproperty list uchar float lens\r\nelement face 4\r\n"
             "property uchar group\r\nproperty list uint8 uint vertex_indices\r\n"
             "property list uchar float texcoord\r\nelement vertex 4\r\nproperty int16 z\r\n"
             "property float64 x\r\nproperty list int int ring\r\nproperty float y\r\nelement edge 0\r\n"
             "end_header\r\n50 2 0.1 0.2\r\n7 3 0 2 1 0\r\n7 3 0 1 3 1 0.5\r\n7 3 0 3 2 0\r\n7 3 1 2 3 0\r\n"
             "0 0 0 0\r\n0 1 1 4 0\r\n0 0 2 1 2 1\r\n1 0 0 0\r\n"));
}

TEST_F(MeshReader, PlyColours) {
    const auto mesh =
        read("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
             "property uchar blue\nproperty uchar red\nproperty uchar green\nproperty uchar alpha\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
             "0 0 0 3 1 2 9\n1 0 0 255 0 0 9\n0 1 0 0 0 0 9\n3 0 1 2\n");
    ASSERT_EQ(mesh.colours.size(), 3u);
    EXPECT_EQ(mesh.colours[0], glm::u8vec3(1, 2, 3));
    EXPECT_EQ(mesh.colours[1], glm::u8vec3(0, 0, 255));
}

TEST_F(MeshReader, StlMergesIdenticalCornersInOrderOfFirstUse) {
    // Facet 0 is 0, 2, 1: its corners become vertices 0, 1, 2; the last corner is used first in facet 1.
    const std::vector<glm::dvec3> positions{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    const std::vector<glm::uvec3> faces{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 3}};
    for (const auto& mesh : {read("binary.stl", stlBinary()), read("text.stl", kStlText)}) {
        EXPECT_EQ(mesh.positions, positions);
        EXPECT_EQ(mesh.faces, faces);
        EXPECT_TRUE(checkClosedSolid(mesh, "tetrahedron").ok());
    }
}

TEST_F(MeshReader, StlMinusZeroIsZeroAndNeighboursStayApart) {
    const auto mesh = read("a.stl", "solid\nfacet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 1 0 "
                                    "0\nvertex 0 1e-4 0\nendloop\nendfacet\n"
                                    "FACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX -0.0 0 -0\nVERTEX 0 1.0000001e-4 "
                                    "0\nVERTEX 1 1 1\nENDLOOP\nENDFACET\nendsolid\n");
    EXPECT_EQ(mesh.faces, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 3, 4}}));
    EXPECT_FALSE(std::signbit(mesh.positions[0].z));
}

TEST_F(MeshReader, StlWhoseHeaderSpeaksOfASolidIsStillBinary) {
    for (const std::string header :
         {";SOLID", "solid organ made by a program that fills the header with words and blanks "}) {
        std::string bytes = stlBinary();
        bytes.replace(0, header.size(), header);
        EXPECT_EQ(read("a.stl", bytes).faces.size(), 4u) << header;
    }
}

TEST_F(MeshReader, StlTextOfSeveralPatches) {
    std::string text = kStlText;
    const std::size_t second = text.find("facet", text.find("endfacet") + 8);
    text.insert(second, "endsolid a\nsolid b\n");
    EXPECT_EQ(read("a.stl", text).faces.size(), 4u);
}

TEST_F(MeshReader, KeepsAllDigits) {
    const auto mesh =
        read("a.obj", "v 0.1234567890123456 1e-7 1500.0000000000002\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(mesh.positions[0], glm::dvec3(0.1234567890123456, 1e-7, 1500.0000000000002));
}

TEST_F(MeshReader, UnusedVerticesSurviveInOrder) {
    const auto mesh = read("a.off", "OFF\n5 1 0\n9 9 9\n0 0 0\n8 8 8\n1 0 0\n0 1 0\n3 1 3 4\n");
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[2], glm::dvec3(8));
    EXPECT_EQ(inspectMesh(mesh, false).unusedVertices, 2u);
}

// Real organs; figures from an independent count with exact arithmetic.
TEST(MeshReaderData, RealSurfacesLoadAndAreSolids) {
    const char* data = std::getenv("SEROSA_DATA");
    if (!data)
        GTEST_SKIP() << "SEROSA_DATA is not set";
    struct Known {
        const char* file;
        std::size_t vertices, faces;
        int genus;
        std::uint64_t crossings;
    };
    for (const Known& known :
         {Known{"surfaces/heart_human.stl", 11281, 22562, 1, 24},
          Known{"surfaces/liver.stl", 9710, 19416, 0, 0},
          Known{"surfaces/gallbladder.stl", 6925, 13846, 0, 0},
          Known{"surfaces/lung_lobe.stl", 22300, 44596, 0, 5},
          Known{"surfaces/armadillo.off", 26002, 52000, 0, 0},
          Known{"surfaces/bunny_10k.obj", 5002, 10000, 0, 0}, Known{"surfaces/lucy.ply", 49987, 99970, 0, 0},
          Known{"tets/liver_surface.obj", 2194, 4384, 0, 7}}) {
        const auto mesh = readMesh(std::filesystem::path(data) / known.file);
        ASSERT_TRUE(mesh.ok()) << mesh.error().message;
        EXPECT_TRUE(checkClosedSolid(*mesh, known.file).ok())
            << checkClosedSolid(*mesh, known.file).error().message;
        const MeshReport report = inspectMesh(*mesh, true);
        EXPECT_EQ(report.vertices, known.vertices) << known.file;
        EXPECT_EQ(report.faces, known.faces) << known.file;
        EXPECT_EQ(report.genus, std::vector<int>{known.genus}) << known.file;
        EXPECT_EQ(report.selfIntersections, known.crossings) << known.file;
    }
}

} // namespace
} // namespace serosa::sim
