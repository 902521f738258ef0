#pragma once
// Exact shares of a closed surface's inside in the cells of a regular grid.

#include "sim/triangle_mesh.h"

#include <glm/glm.hpp>

#include <vector>

namespace serosa::sim {

/// A box of unit cells: cell (x, y, z) spans [x, x+1] and so on, in grid units.
struct CellGrid {
    glm::dvec3 origin{0}; // metres of grid point (0, 0, 0)
    double spacing = 1;   // m
    glm::ivec3 dims{0};   // cells

    std::size_t count() const { return std::size_t(dims.x) * std::size_t(dims.y) * std::size_t(dims.z); }
    std::size_t index(int x, int y, int z) const {
        return (std::size_t(z) * std::size_t(dims.y) + std::size_t(y)) * std::size_t(dims.x) + std::size_t(x);
    }
};

/// The smallest grid of cells of `spacing` around the bounds of a surface, centred on it. Extents that are a
/// whole number of cells (to 1e-6 of one) get just that many.
CellGrid gridAround(const glm::dvec3& lowest, const glm::dvec3& highest, double spacing);

/// The smallest grid around the bounds that has a grid point at `point`, m.
CellGrid gridThrough(const glm::dvec3& point, const glm::dvec3& lowest, const glm::dvec3& highest,
                     double spacing);

/// Share of each cell's volume inside the surface, 0 .. 1, index as CellGrid::index. `metres` is closed and
/// wound outward, and lies inside the grid (points up to rounding outside are moved to its border). Nested
/// cavities count as outside; where the surface crosses itself the winding number is clamped to 0 .. 1.
std::vector<double> cellFills(const TriangleMesh& metres, const CellGrid& grid);

} // namespace serosa::sim
