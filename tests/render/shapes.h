#pragma once
// Small meshes and lattices that the render tests share.

#include "sim/lattice.h"
#include "sim/triangle_mesh.h"

#include <array>
#include <cmath>
#include <map>

namespace serosa::test {

/// A ball of radius `radius` about `centre` from a cube with n x n squares a face, pushed onto the sphere
/// evenly.
inline sim::TriangleMesh ballMesh(int n, double radius, const glm::dvec3& centre) {
    sim::TriangleMesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> ids;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1})
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int a, int b) {
                        std::array<int, 3> c{};
                        c[std::size_t(axis)] = side * n;
                        c[std::size_t((axis + 1) % 3)] = 2 * a - n;
                        c[std::size_t((axis + 2) % 3)] = 2 * b - n;
                        const auto [it, fresh] = ids.try_emplace(c, std::uint32_t(mesh.positions.size()));
                        if (fresh) {
                            const glm::dvec3 p =
                                glm::tan(0.25 * 3.14159265358979 / n * glm::dvec3(c[0], c[1], c[2]));
                            mesh.positions.push_back(centre + radius * glm::normalize(p));
                        }
                        return it->second;
                    };
                    const std::uint32_t p = corner(i, j), q = corner(i + 1, j), r = corner(i + 1, j + 1),
                                        s = corner(i, j + 1);
                    if (side > 0) {
                        mesh.faces.emplace_back(p, q, r);
                        mesh.faces.emplace_back(p, r, s);
                    } else {
                        mesh.faces.emplace_back(p, r, q);
                        mesh.faces.emplace_back(p, s, r);
                    }
                }
    return mesh;
}

/// Full cells of a box of nx x ny x nz cells.
inline sim::Lattice boxLattice(int nx, int ny, int nz, double spacing, const glm::dvec3& origin) {
    std::vector<sim::LatticeCell> cells(std::size_t(nx * ny * nz));
    for (int i = 0; i < nx * ny * nz; ++i)
        cells[std::size_t(i)] = {{i % nx, i / nx % ny, i / (nx * ny)}, 255};
    return sim::latticeFromCells(cells, spacing, origin);
}

/// A lattice of the cells that a ball touches (by the corner nearest to its centre), all full.
inline sim::Lattice ballLattice(double radiusInSpacings, double spacing, const glm::dvec3& origin) {
    std::vector<sim::LatticeCell> cells;
    const int n = int(std::ceil(radiusInSpacings));
    for (int z = -n; z < n; ++z)
        for (int y = -n; y < n; ++y)
            for (int x = -n; x < n; ++x) {
                const glm::dvec3 nearest =
                    glm::clamp(glm::dvec3(0), glm::dvec3(x, y, z), glm::dvec3(x + 1, y + 1, z + 1));
                if (glm::length(nearest) < radiusInSpacings)
                    cells.push_back({{x + n, y + n, z + n}, 255});
            }
    return sim::latticeFromCells(cells, spacing, origin);
}

} // namespace serosa::test
