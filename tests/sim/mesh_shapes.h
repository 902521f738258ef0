#pragma once
// Small surfaces, good and bad, for the tests of reading, checking and writing.

#include "sim/triangle_mesh.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace serosa::sim {

/// An axis-aligned box, wound outward; 8 vertices, 12 triangles.
inline TriangleMesh box(const glm::dvec3& lowest, const glm::dvec3& highest) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(
            {i & 1 ? highest.x : lowest.x, i & 2 ? highest.y : lowest.y, i & 4 ? highest.z : lowest.z});
    mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

inline TriangleMesh cube(double half) {
    return box(glm::dvec3(-half), glm::dvec3(half));
}

/// A tetrahedron of volume 1/6, wound outward.
inline TriangleMesh tetrahedron() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}},
            {},
            {},
            {}};
}

inline TriangleMesh inverted(TriangleMesh mesh) {
    for (auto& face : mesh.faces)
        std::swap(face.y, face.z);
    return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const glm::dvec3& by) {
    for (auto& p : mesh.positions)
        p += by;
    return mesh;
}

inline TriangleMesh scaled(TriangleMesh mesh, double by) {
    for (auto& p : mesh.positions)
        p *= by;
    return mesh;
}

/// Both in one mesh, sharing nothing.
inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
    const auto offset = static_cast<std::uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const auto& face : b.faces)
        a.faces.push_back(face + glm::uvec3(offset));
    return a;
}

/// A torus around z, of `n` by `n` quads of two triangles, wound outward; genus 1.
inline TriangleMesh torus(std::uint32_t n, double large, double small) {
    TriangleMesh mesh;
    const double step = 2 * 3.14159265358979323846 / n;
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const double r = large + small * std::cos(j * step);
            mesh.positions.push_back(
                {r * std::cos(i * step), r * std::sin(i * step), small * std::sin(j * step)});
        }
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t k = (i + 1) % n, l = (j + 1) % n;
            mesh.faces.push_back({i * n + j, k * n + j, k * n + l});
            mesh.faces.push_back({i * n + j, k * n + l, i * n + l});
        }
    return mesh;
}

} // namespace serosa::sim
