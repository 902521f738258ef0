// Boxes are spheres whose eight octants lie apart, with the faces between; rods and hooks are circles along a
// path; meshes get a normal a corner, which keeps edges.
#include "render/tool_meshes.h"

#include "sim/triangle_mesh.h"

#include <cmath>
#include <numbers>

namespace serosa::render {

namespace {

constexpr int kAround = 72, kDown = 36;  // of a sphere; both even, kAround a multiple of 4
constexpr int kAroundRod = 32, kCap = 8; // of a rod and its round ends
constexpr int kBendSteps = 32;           // of a hook's half circle
constexpr double kCrease = 0.77;         // cosine: faces of a mesh that turn further keep an edge

void addQuad(std::vector<std::uint32_t>& indices, std::uint32_t a, std::uint32_t b, std::uint32_t c,
             std::uint32_t d) {
    indices.insert(indices.end(), {a, b, c, c, b, d});
}

/// The grid of vertices in `columns` columns, as triangles.
void addGrid(ToolMesh& mesh, std::uint32_t columns) {
    const auto rows = std::uint32_t(mesh.vertices.size()) / columns;
    for (std::uint32_t i = 0; i + 1 < rows; ++i)
        for (std::uint32_t j = 0; j + 1 < columns; ++j) {
            const std::uint32_t a = i * columns + j, b = a + columns;
            addQuad(mesh.indices, a, b, a + 1, b + 1);
        }
}

ToolMesh sphere() {
    ToolMesh mesh;
    for (int i = 0; i <= kDown; ++i)
        for (int j = 0; j <= kAround; ++j) {
            const double polar = std::numbers::pi * i / kDown, around = 2 * std::numbers::pi * j / kAround;
            mesh.vertices.push_back(
                {glm::vec3(0), glm::vec3(std::sin(polar) * std::sin(around), std::cos(polar),
                                         std::sin(polar) * std::cos(around))});
        }
    addGrid(mesh, kAround + 1);
    return mesh;
}

ToolMesh box(const glm::dvec3& middle, const glm::dvec3& half) {
    ToolMesh mesh;
    constexpr int kQuarter = kAround / 4, kRows = kDown + 2, kColumns = kAround + 5;
    // Rows from the pole +y down, the equator twice; columns around y from +z, each turn of a quarter twice.
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const bool above = row <= kDown / 2;
            const int quarter = std::min(column / (kQuarter + 1), 4),
                      j = column - quarter; // 4: closes the ring
            const double polar = std::numbers::pi * (above ? row : row - 1) / kDown,
                         around = 2 * std::numbers::pi * j / kAround;
            const glm::dvec3 side(quarter == 0 || quarter == 1 || quarter == 4 ? 1 : -1, above ? 1 : -1,
                                  quarter == 0 || quarter == 3 || quarter == 4 ? 1 : -1);
            mesh.vertices.push_back({glm::vec3(middle + side * half),
                                     glm::vec3(std::sin(polar) * std::sin(around), std::cos(polar),
                                               std::sin(polar) * std::cos(around))});
        }
    addGrid(mesh, kColumns);
    const auto corner = [](int row, int quarter) {
        return std::uint32_t(row * kColumns + quarter * (kQuarter + 1));
    };
    addQuad(mesh.indices, corner(0, 0), corner(0, 1), corner(0, 3), corner(0, 2)); // +y
    addQuad(mesh.indices, corner(kRows - 1, 0), corner(kRows - 1, 3), corner(kRows - 1, 1),
            corner(kRows - 1, 2)); // -y
    return mesh;
}

struct PathPoint {
    glm::dvec3 at, tangent;
};

/// A circle along a path in the plane x = 0, with half spheres at its ends.
ToolMesh rod(const std::vector<PathPoint>& path) {
    ToolMesh mesh;
    const auto ring = [&mesh](const PathPoint& point, double lean) { // lean of the normal along the tangent
        const glm::dvec3 x(1, 0, 0), across = glm::cross(point.tangent, x);
        for (int j = 0; j <= kAroundRod; ++j) {
            const double around = 2 * std::numbers::pi * (j % kAroundRod) / kAroundRod;
            const glm::dvec3 out = std::cos(around) * x + std::sin(around) * across;
            mesh.vertices.push_back(
                {glm::vec3(point.at), glm::vec3(std::cos(lean) * out + std::sin(lean) * point.tangent)});
        }
    };
    for (int i = -kCap; i < 0; ++i)
        ring(path.front(), 0.5 * std::numbers::pi * i / kCap);
    for (const PathPoint& point : path)
        ring(point, 0);
    for (int i = 1; i <= kCap; ++i)
        ring(path.back(), 0.5 * std::numbers::pi * i / kCap);
    // Rings run along the tangent: a row's next column, then its next row, turn counter-clockwise outside.
    constexpr std::uint32_t kColumns = kAroundRod + 1;
    const auto rows = std::uint32_t(mesh.vertices.size()) / kColumns;
    for (std::uint32_t i = 0; i + 1 < rows; ++i)
        for (std::uint32_t j = 0; j + 1 < kColumns; ++j) {
            const std::uint32_t a = i * kColumns + j, b = a + kColumns;
            addQuad(mesh.indices, a, a + 1, b, b + 1);
        }
    return mesh;
}

std::vector<PathPoint> hookPath(double bend, double length) {
    std::vector<PathPoint> path;
    for (int i = 0; i <= kBendSteps; ++i) {
        const double turn = std::numbers::pi * i / kBendSteps;
        path.push_back(
            {{0, bend * std::cos(turn), -bend * std::sin(turn)}, {0, -std::sin(turn), -std::cos(turn)}});
    }
    path.push_back({{0, -bend, length}, {0, 0, 1}});
    return path;
}

/// Corners that share a position and faces that turn little share a normal.
ToolMesh surfaceMesh(const sim::TriangleMesh& surface) {
    std::vector<glm::dvec3> faceNormals; // as long as twice the area
    std::vector<std::vector<std::uint32_t>> facesOf(surface.positions.size());
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
        const glm::uvec3& face = surface.faces[f];
        faceNormals.push_back(glm::cross(surface.positions[face.y] - surface.positions[face.x],
                                         surface.positions[face.z] - surface.positions[face.x]));
        for (int c = 0; c < 3; ++c)
            facesOf[face[c]].push_back(f);
    }
    ToolMesh mesh;
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f)
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t vertex = surface.faces[f][c];
            glm::dvec3 sum(0);
            for (const std::uint32_t other : facesOf[vertex])
                if (glm::dot(faceNormals[other], faceNormals[f]) >=
                    kCrease * glm::length(faceNormals[other]) * glm::length(faceNormals[f]))
                    sum += faceNormals[other];
            mesh.indices.push_back(std::uint32_t(mesh.vertices.size()));
            mesh.vertices.push_back({glm::vec3(surface.positions[vertex]), glm::vec3(glm::normalize(sum))});
        }
    return mesh;
}

} // namespace

ToolMesh toolMesh(const sim::RigidShape& shape) {
    switch (shape.kind) {
    case sim::ShapeKind::sphere:
        return sphere();
    case sim::ShapeKind::capsule:
        return rod({{{0, 0, 0}, {0, 0, 1}}, {{0, 0, shape.length}, {0, 0, 1}}});
    case sim::ShapeKind::box:
        return box(shape.middle, shape.halfSize);
    case sim::ShapeKind::hook:
        return rod(hookPath(shape.bend, shape.length));
    case sim::ShapeKind::mesh:
        return shape.surface ? surfaceMesh(*shape.surface) : ToolMesh{};
    case sim::ShapeKind::halfSpace:
        break;
    }
    return {};
}

ToolMesh floorPatch() {
    ToolMesh mesh;
    for (int i = 0; i < 4; ++i)
        mesh.vertices.push_back({{i & 1 ? 1 : -1, 0, i & 2 ? 1 : -1}, {0, 1, 0}});
    mesh.indices = {0, 2, 1, 1, 2, 3};
    return mesh;
}

} // namespace serosa::render
