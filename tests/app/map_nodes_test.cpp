// `serosa map`: a surface that follows nodes from files.
#include "app/map_nodes.h"
#include "sim/mesh_reader.h"
#include "sim/mesh_writer.h"
#include "tests/render/shapes.h"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

namespace serosa::app {
namespace {

namespace fs = std::filesystem;
using sim::TriangleMesh;

class MapNodes : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ =
            fs::path(::testing::TempDir()) /
            ("serosa_map_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "frames");
        nodes_ = test::ballMesh(3, 40, {5, 6, 7}); // mm
        surface_ = test::ballMesh(16, 41, {5, 6, 7});
        for (std::size_t v = 0; v < surface_.positions.size(); ++v) // bumps
            surface_.positions[v] += 1.5 * std::sin(0.3 * surface_.positions[v].x) *
                                     (surface_.positions[v] - glm::dvec3(5, 6, 7)) / 40.0;
        options_.surface = folder_ / "surface.ply";
        options_.nodes = folder_ / "nodes.obj";
        options_.frames = folder_ / "frames";
        options_.lengthUnit = "mm";
        options_.out = folder_ / "out";
        write(surface_, options_.surface);
        write(nodes_, options_.nodes);
    }
    void TearDown() override { fs::remove_all(folder_); }

    static void write(const TriangleMesh& mesh, const fs::path& file) {
        const Status done = sim::writeMesh(mesh, file);
        ASSERT_TRUE(done.ok()) << done.error().message;
    }
    template <class Move>
    static TriangleMesh moved(TriangleMesh mesh, const Move& move) {
        for (glm::dvec3& p : mesh.positions)
            p = move(p);
        return mesh;
    }
    Result<int> map() {
        std::ostringstream out;
        return mapNodes(options_, out);
    }
    void fails(const std::string& with) {
        const Result<int> result = map();
        ASSERT_FALSE(result.ok());
        EXPECT_NE(result.error().message.find(with), std::string::npos) << result.error().message;
        EXPECT_FALSE(fs::exists(options_.out)) << "left behind";
    }
    double apart(const TriangleMesh& expected, const char* file) {
        const auto read = sim::readMesh(options_.out / file);
        EXPECT_TRUE(read.ok());
        EXPECT_EQ(read.value().faces, expected.faces);
        double largest = 0;
        for (std::size_t v = 0; v < expected.positions.size(); ++v)
            largest = std::max(largest, glm::distance(read.value().positions[v], expected.positions[v]));
        return largest;
    }

    fs::path folder_;
    TriangleMesh nodes_, surface_;
    MapOptions options_;
};

TEST_F(MapNodes, RestReturnsAndRigidMotionIsFollowed) {
    const glm::dquat turn = glm::angleAxis(2.0, glm::normalize(glm::dvec3(1, -2, 0.5)));
    const auto move = [&](const glm::dvec3& p) { return turn * p + glm::dvec3(100, -50, 20); };
    write(nodes_, options_.frames / "a.ply");
    write(moved(nodes_, move), options_.frames / "b.ply");
    for (const sim::Mapping mapping : {sim::Mapping::triangle, sim::Mapping::curvature, sim::Mapping::chosen,
                                       sim::Mapping::normalOffset, sim::Mapping::nodeFrames}) {
        options_.mapping = mapping;
        options_.force = true;
        const Result<int> done = map();
        ASSERT_TRUE(done.ok()) << done.error().message;
        EXPECT_LE(apart(surface_, "surface_000001.ply"), 1e-4) << int(mapping); // mm: 1e-6 of the size
        EXPECT_LE(apart(moved(surface_, move), "surface_000002.ply"), 1e-3) << int(mapping);
    }
}

TEST_F(MapNodes, ASingleTriangleCanBeFollowed) {
    TriangleMesh one;
    one.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
    one.faces = {{0, 1, 2}};
    write(one, options_.nodes);
    TriangleMesh above = one;
    for (glm::dvec3& p : above.positions)
        p = 0.5 * p + glm::dvec3(1, 1, 2);
    write(above, options_.surface);
    const auto move = [](const glm::dvec3& p) { return glm::dvec3(-p.y, p.x, p.z + 3); };
    write(moved(one, move), options_.frames / "0.obj");
    ASSERT_TRUE(map().ok());
    EXPECT_LE(apart(moved(above, move), "surface_000001.ply"), 1e-4);
}

TEST_F(MapNodes, BadInputIsOneClearError) {
    fails("holds no mesh");
    write(nodes_, options_.frames / "a.ply");
    write(test::ballMesh(4, 40, {5, 6, 7}), options_.frames / "b.ply");
    fails("b.ply: has 98 vertices, the nodes are 56");
    TriangleMesh turned = nodes_;
    std::swap(turned.faces[0], turned.faces[1]);
    write(turned, options_.frames / "b.ply");
    fails("b.ply: has other faces than the nodes");
    write(nodes_, options_.frames / "b.ply");
    write(moved(surface_, [](const glm::dvec3& p) { return p + glm::dvec3(400, 0, 0); }), options_.surface);
    fails("of the surface (the first is 0) lies ");
    options_.mapping = sim::Mapping::trilinear;
    fails("need a lattice");
    options_.mapping = sim::Mapping::triangle;
    options_.lengthUnit = "furlong";
    fails("furlong");
    options_.lengthUnit = "mm";
    options_.frames = folder_ / "none";
    fails("is no folder");
    options_.nodes = folder_ / "none.ply";
    fails("none.ply");
}

} // namespace
} // namespace serosa::app
