// The triangles that tools are drawn with, against what contact knows of their shapes: every vertex lies on
// the surface with its normal, the mesh is closed and wound outward, and holds the shape's volume. And what
// is drawn of a scene at a time.

#include "render/tool_meshes.h"
#include "render/tool_shapes.h"
#include "sim/distance_field.h"
#include "sim/shape_distance.h"
#include "sim/triangle_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace serosa::render {
namespace {

constexpr double kPi = std::numbers::pi;

sim::RigidShape shapeOf(sim::ShapeKind kind, double radius) {
    sim::RigidShape shape;
    shape.kind = kind;
    shape.radius = radius;
    return shape;
}

struct Case {
    const char* name;
    sim::RigidShape shape;
    double volume; // closed form
};

std::vector<Case> cases() {
    const double r = 0.003, ball = 4.0 / 3 * kPi * r * r * r;
    sim::RigidShape capsule = shapeOf(sim::ShapeKind::capsule, r), box = shapeOf(sim::ShapeKind::box, r),
                    blade = box, hook = shapeOf(sim::ShapeKind::hook, r);
    capsule.length = 0.04;
    box.middle = {0.001, -0.002, 0.003};
    box.halfSize = {0.004, 0.006, 0.01};
    blade.halfSize = {0.01, 0, 0.02};
    hook.bend = 0.008;
    hook.length = 0.03;
    const auto rounded = [&](const glm::dvec3& s) { // Steiner, of sides s
        return s.x * s.y * s.z + 2 * r * (s.x * s.y + s.y * s.z + s.z * s.x) +
               kPi * r * r * (s.x + s.y + s.z) + ball;
    };
    return {{"sphere", shapeOf(sim::ShapeKind::sphere, r), ball},
            {"capsule", capsule, ball + kPi * r * r * capsule.length},
            {"box", box, rounded(2.0 * box.halfSize)},
            {"blade", blade, rounded(2.0 * blade.halfSize)},
            {"hook", hook, ball + kPi * r * r * (hook.length + kPi * hook.bend)}};
}

TEST(ToolMeshes, LieOnTheSurfacesThatContactKnows) {
    for (const Case& each : cases()) {
        SCOPED_TRACE(each.name);
        const ToolMesh mesh = toolMesh(each.shape);
        sim::TriangleMesh metres;
        double furthest = 0, turned = 0;
        for (const ToolVertex& vertex : mesh.vertices) {
            const glm::dvec3 normal(vertex.normal), at = glm::dvec3(vertex.core) + each.shape.radius * normal;
            const sim::ShapeSample sample = sim::sampleShape(each.shape, at);
            furthest = std::max(furthest, std::abs(sample.distance));
            turned = std::max(turned, glm::distance(sample.normal, normal));
            metres.positions.push_back(at);
        }
        EXPECT_LT(furthest, 1e-8);
        EXPECT_LT(turned, 1e-4);
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
            metres.faces.emplace_back(mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]);
        EXPECT_NEAR(metres.volume(), each.volume, 0.015 * each.volume);
        // Closed: every edge between two places is walked once in each direction.
        std::map<std::array<long, 3>, std::size_t> places;
        const auto place = [&](std::uint32_t vertex) {
            const glm::dvec3 p = metres.positions[vertex] * 1e7;
            return places
                .emplace(std::array<long, 3>{std::lround(p.x), std::lround(p.y), std::lround(p.z)},
                         places.size())
                .first->second;
        };
        std::map<std::pair<std::size_t, std::size_t>, int> edges;
        for (const glm::uvec3& face : metres.faces)
            for (int c = 0; c < 3; ++c) {
                const std::size_t a = place(face[c]), b = place(face[(c + 1) % 3]);
                if (a != b)
                    edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
            }
        for (const auto& [edge, sum] : edges)
            EXPECT_EQ(sum, 0);
    }
}

TEST(ToolMeshes, MeshesKeepEdgesAndFloorsFaceUp) {
    sim::TriangleMesh cube;
    for (int i = 0; i < 8; ++i)
        cube.positions.emplace_back(i & 1, (i & 2) / 2, (i & 4) / 4);
    cube.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    sim::RigidShape shape = shapeOf(sim::ShapeKind::mesh, 0);
    EXPECT_TRUE(toolMesh(shape).vertices.empty()) << "no surface is known";
    shape.surface = std::make_shared<sim::TriangleMesh>(cube);
    const ToolMesh mesh = toolMesh(shape);
    ASSERT_EQ(mesh.indices.size(), 36u);
    for (std::size_t face = 0; face < 12; ++face)
        for (std::size_t c = 0; c < 3; ++c) {
            const glm::vec3 normal = mesh.vertices[mesh.indices[3 * face + c]].normal;
            const glm::uvec3& f = cube.faces[face];
            const glm::dvec3 flat = glm::normalize(glm::cross(cube.positions[f.y] - cube.positions[f.x],
                                                              cube.positions[f.z] - cube.positions[f.x]));
            EXPECT_LT(glm::distance(glm::dvec3(normal), flat), 1e-6);
        }
    const ToolMesh floor = floorPatch();
    for (std::size_t i = 0; i < floor.indices.size(); i += 3) {
        const auto at = [&](std::size_t c) { return floor.vertices[floor.indices[i + c]].core; };
        EXPECT_GT(glm::cross(at(1) - at(0), at(2) - at(0)).y, 0);
    }
}

// Jaws are open before their first key, touch what they hold while they do, and open again.
TEST(DrawnShapes, JawsCloseOnWhatTheyHold) {
    sim::Tool jaws;
    jaws.mode = sim::ToolMode::grasp;
    jaws.jaws = true;
    jaws.radius = 0;
    jaws.shape.kind = sim::ShapeKind::box;
    jaws.shape.middle = {0, 0, 0.006};
    jaws.shape.halfSize = {0.003, 0.004, 0.006};
    jaws.keys = {{1, {0, 0, 0}}, {2, {0, 0.01, 0}}};
    // The least gap between a pad and the middle of the tip.
    const auto gap = [&](double time) {
        double least = 1;
        for (const DrawnShape& drawn : drawnTool(jaws, time)) {
            const glm::dvec3 tip = jaws.poseAt(time).toWorld({0, 0, 0.001});
            least = std::min(least, sim::shapeDistance(drawn.shape, drawn.pose.toOwn(tip)));
        }
        return least;
    };
    EXPECT_NEAR(gap(1), 0.004, 1e-9);
    EXPECT_NEAR(gap(1.5), 0.004, 1e-9);
    EXPECT_NEAR(gap(2), 0.004, 1e-9);
    EXPECT_GT(gap(0), 0.007);
    EXPECT_GT(gap(3), 0.007);
}

TEST(DrawnShapes, FloorsLieBelowTheOrgansAndHandsThatRestAreNotSeen) {
    sim::Scene scene;
    sim::Body floor;
    floor.shape = shapeOf(sim::ShapeKind::halfSpace, 0);
    floor.pose.at = {5, -1, 7};
    sim::Body bone;
    bone.pose.at = {1, 2, 3};
    scene.bodies = {floor, bone};
    const auto live = std::make_shared<sim::LiveTool>();
    sim::Tool hand;
    hand.live = live;
    scene.tools = {hand};
    const glm::dvec3 lowest(-0.1, 0, 0.2), highest(0.3, 0.2, 0.4);
    std::vector<DrawnShape> shapes = drawnShapes(scene, 0, lowest, highest);
    ASSERT_EQ(shapes.size(), 2u);
    EXPECT_EQ(shapes[0].finish, Finish::floor);
    EXPECT_LT(glm::distance(shapes[0].pose.at, glm::dvec3(0.1, -1, 0.3)), 1e-12);
    EXPECT_GT(shapes[0].extent, 0.5 * glm::distance(lowest, highest));
    EXPECT_EQ(shapes[1].finish, Finish::matte);
    live->add({0, {1, 1, 1}, {1, 0, 0, 0}, true});
    shapes = drawnShapes(scene, 0, lowest, highest);
    ASSERT_EQ(shapes.size(), 3u);
    EXPECT_EQ(shapes[0].pose.at, glm::dvec3(1, 1, 1));
}

} // namespace
} // namespace serosa::render
