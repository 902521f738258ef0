#pragma once
// Small shapes that the lattice and solver tests share.

#include "sim/lattice.h"
#include "sim/triangle_mesh.h"

namespace serosa::test {

/// A closed box from `low` to `high`, m, wound outward.
inline sim::TriangleMesh boxMesh(const glm::dvec3& low, const glm::dvec3& high) {
    sim::TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.emplace_back(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                    corner & 4 ? high.z : low.z);
    mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

/// Appends a mesh; `inward` turns its faces, which makes it a cavity.
inline void append(sim::TriangleMesh& mesh, const sim::TriangleMesh& other, bool inward) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (glm::uvec3 face : other.faces) {
        if (inward)
            std::swap(face.y, face.z);
        mesh.faces.push_back(face + first);
    }
}

/// A closed ball: a subdivided octahedron, `levels` times.
inline sim::TriangleMesh ballMesh(double radius, int levels) {
    sim::TriangleMesh mesh;
    const int n = 1 << levels; // edge cuts of each octant
    for (int octant = 0; octant < 8; ++octant) {
        const glm::dvec3 sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
        const bool mirrored = sign.x * sign.y * sign.z < 0;
        const auto first = std::uint32_t(mesh.positions.size());
        const auto index = [first, n](int i, int j) {
            return first + std::uint32_t(i * (n + 1) - i * (i - 1) / 2 + j);
        };
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n - i; ++j)
                mesh.positions.push_back(radius * sign * glm::normalize(glm::dvec3(n - i - j, i, j)));
        const auto add = [&mesh, mirrored](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            mesh.faces.emplace_back(a, mirrored ? c : b, mirrored ? b : c);
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n - i; ++j) {
                add(index(i, j), index(i + 1, j), index(i, j + 1));
                if (i + j < n - 1)
                    add(index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
            }
    }
    return mesh; // octants repeat the vertices of their common edges: closed as a set of points
}

/// A block of full cells.
inline sim::Lattice blockLattice(int nx, int ny, int nz, double spacing = 0.003) {
    std::vector<sim::LatticeCell> cells;
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x)
                cells.push_back({{x, y, z}, 255});
    return sim::latticeFromCells(cells, spacing, glm::dvec3(0));
}

} // namespace serosa::test
