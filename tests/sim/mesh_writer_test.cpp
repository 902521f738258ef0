// What is written reads back: the same bits, order and colours; and no failure leaves a file or a temporary
// behind.
#include "sim/mesh_check.h"
#include "sim/mesh_reader.h"
#include "sim/mesh_writer.h"
#include "tests/sim/mesh_files.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>

namespace serosa::sim {
namespace {

class MeshWriter : public MeshFiles {
protected:
    TriangleMesh roundTrip(const TriangleMesh& mesh, const std::string& name) {
        const Status written = writeMesh(mesh, folder_ / name);
        EXPECT_TRUE(written.ok()) << written.error().message;
        auto read = readMesh(folder_ / name);
        EXPECT_TRUE(read.ok()) << read.error().message;
        return read.ok() ? *std::move(read) : TriangleMesh();
    }
    void expectRefused(const TriangleMesh& mesh, const std::filesystem::path& path, const std::string& what) {
        const std::size_t before = entries();
        const Status status = writeMesh(mesh, path);
        ASSERT_FALSE(status.ok()) << path;
        EXPECT_EQ(status.error().message.find(path.string() + ": "), 0u) << status.error().message;
        EXPECT_NE(status.error().message.find(what), std::string::npos) << status.error().message;
        EXPECT_EQ(entries(), before);
    }
};

/// Far from the origin, with digits that float32 loses, an unused vertex first and colours.
TriangleMesh awkward() {
    TriangleMesh mesh = moved(scaled(torus(9, 3, 1), 1 / 7.0), {850.1, -1e-7, 1600});
    mesh.positions.insert(mesh.positions.begin(), {1e-300, -0.0, 123456789.123456789});
    for (auto& face : mesh.faces)
        face += glm::uvec3(1);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.colours.push_back(glm::u8vec3(glm::uvec3(3 * i % 256, 255 - i, 7 * i % 256)));
    return mesh;
}

TEST_F(MeshWriter, KeepsEveryBitAndTheOrder) {
    for (const std::string extension : {"ply", "obj", "off"})
        for (const bool coloured : {true, false}) {
            TriangleMesh mesh = awkward();
            if (!coloured)
                mesh.colours.clear();
            const TriangleMesh back = roundTrip(mesh, "a." + extension);
            ASSERT_EQ(back.positions.size(), mesh.positions.size()) << extension;
            for (std::size_t i = 0; i < mesh.positions.size(); ++i)
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_EQ(std::bit_cast<std::uint64_t>(back.positions[i][axis]),
                              std::bit_cast<std::uint64_t>(mesh.positions[i][axis]))
                        << extension << " vertex " << i;
            EXPECT_EQ(back.faces, mesh.faces) << extension;
            EXPECT_EQ(back.colours, mesh.colours) << extension;
        }
}

TEST_F(MeshWriter, EveryColourValueSurvivesText) {
    TriangleMesh mesh = tetrahedron();
    for (int i = 4; i < 256; ++i)
        mesh.positions.push_back({i, 0, 0});
    for (int i = 0; i < 256; ++i)
        mesh.colours.push_back(glm::u8vec3(static_cast<std::uint8_t>(i)));
    EXPECT_EQ(roundTrip(mesh, "a.obj").colours, mesh.colours);
}

/// Rounded to float32. Volatile, because g++ 12 -O2 drops the rounding of adjacent doubles when it
/// vectorizes.
double float32(double value) {
    volatile float rounded = static_cast<float>(value);
    return static_cast<double>(rounded);
}

TEST_F(MeshWriter, StlKeepsFacesAndFloat32Positions) {
    const TriangleMesh mesh = torus(12, 3, 1);
    const TriangleMesh back = roundTrip(mesh, "a.STL");
    ASSERT_EQ(back.faces.size(), mesh.faces.size());
    EXPECT_EQ(back.positions.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.faces.size(); ++i)
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 &a = mesh.positions[mesh.faces[i][corner]],
                             &b = back.positions[back.faces[i][corner]];
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_EQ(float32(a[axis]), b[axis]);
        }
    EXPECT_TRUE(checkClosedSolid(back, "a.STL").ok());
    const std::string bytes = content(folder_ / "a.STL");
    EXPECT_NE(bytes.substr(0, 5), "solid");
    // The first triangle's normal: outward, of unit length.
    float normal[3];
    std::memcpy(normal, bytes.data() + 84, sizeof normal);
    EXPECT_NEAR(std::hypot(normal[0], normal[1], normal[2]), 1, 1e-6);
    EXPECT_GT(normal[0], 0.9f);
}

TEST_F(MeshWriter, WritesSurfacesThatACutHasOpened) {
    TriangleMesh mesh = cube(1);
    mesh.faces.pop_back();
    mesh.faces.push_back({0, 7, 8});
    mesh.faces.push_back({0, 7, 8});
    mesh.positions.push_back({9, 9, 9});
    EXPECT_EQ(roundTrip(mesh, "a.ply").faces, mesh.faces);
}

TEST_F(MeshWriter, RefusesWhatItCannotWrite) {
    const TriangleMesh mesh = cube(1);
    expectRefused(mesh, folder_ / "a.vtk", "use .ply, .obj, .off or .stl");
    expectRefused(mesh, folder_ / "a", "unknown extension ''");
    expectRefused(mesh, folder_ / "no_such" / "a.ply", "make the folder first");
    expectRefused({mesh.positions, {}, {}, {}, {}}, folder_ / "a.ply", "no triangles");
    TriangleMesh broken = mesh;
    broken.positions[2].z = std::numeric_limits<double>::quiet_NaN();
    expectRefused(broken, folder_ / "a.ply", "vertex 2 (from 0) has a coordinate that is not finite");
    expectRefused(scaled(mesh, 1e39), folder_ / "a.stl", "too large for STL");
    std::filesystem::create_directory(folder_ / "taken.ply");
    expectRefused(mesh, folder_ / "taken.ply", "a folder");
    file("plain", "x");
    expectRefused(mesh, folder_ / "plain" / "a.ply", "is a file, not a folder");
}

// A limit on the file size stands for a full disk: write() stores a part and then fails, as it does there.
TEST_F(MeshWriter, ADiskThatFillsUpLeavesTheOldFile) {
    file("a.ply", "old");
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{4096, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    expectRefused(torus(30, 3, 1), folder_ / "a.ply", "cannot be written");
    expectRefused(torus(30, 3, 1), folder_ / "b.obj", "cannot be written");
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(content(folder_ / "a.ply"), "old");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b.obj"));
}

} // namespace
} // namespace serosa::sim
