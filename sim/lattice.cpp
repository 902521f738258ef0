// Lattice topology from a set of filled cells: nodes, the 18 connections, fills and the boundary (MS05 3.1;
// the cells instead of the nodes are material, see sim/lattice.h).
#include "sim/lattice.h"

#include "sim/node_depths.h"

#include <algorithm>
#include <tuple>

namespace serosa::sim {

const std::array<glm::ivec3, 18> kNeighbourOffsets = {{{1, 0, 0},
                                                       {-1, 0, 0},
                                                       {0, 1, 0},
                                                       {0, -1, 0},
                                                       {0, 0, 1},
                                                       {0, 0, -1},
                                                       {1, 1, 0},
                                                       {-1, -1, 0},
                                                       {1, -1, 0},
                                                       {-1, 1, 0},
                                                       {1, 0, 1},
                                                       {-1, 0, -1},
                                                       {1, 0, -1},
                                                       {-1, 0, 1},
                                                       {0, 1, 1},
                                                       {0, -1, -1},
                                                       {0, 1, -1},
                                                       {0, -1, 1}}};

namespace {

std::size_t gridIndex(const glm::ivec3& p, const glm::ivec3& dims) {
    return (std::size_t(p.z) * std::size_t(dims.y) + std::size_t(p.y)) * std::size_t(dims.x) +
           std::size_t(p.x);
}

/// The two triangles of each outer face of each material cell.
void addBoundary(Lattice& lattice, const std::vector<std::uint8_t>& fillOfCell) {
    const glm::ivec3 cellDims = lattice.nodeDims - 1;
    for (const LatticeCell& cell : lattice.cells) {
        for (int face = 0; face < 6; ++face) {
            const int axis = face / 2, side = face % 2; // side 1: towards +axis
            glm::ivec3 next = cell.grid;
            next[axis] += side ? 1 : -1;
            const bool inGrid = next[axis] >= 0 && next[axis] < cellDims[axis];
            if (inGrid && fillOfCell[gridIndex(next, cellDims)] > 0)
                continue;
            // Corners counter-clockwise seen from outside: u, v follow axis cyclically; mirrored on the low
            // side.
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::array<std::uint32_t, 4> quad;
            const std::array<glm::ivec2, 4> ring = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
            for (std::size_t i = 0; i < 4; ++i) {
                const glm::ivec2 uv = ring[side ? i : 3 - i];
                glm::ivec3 corner = cell.grid;
                corner[axis] += side;
                corner[u] += uv.x;
                corner[v] += uv.y;
                quad[i] = std::uint32_t(lattice.nodeAt(corner));
            }
            const std::size_t low = std::size_t(std::min_element(quad.begin(), quad.end()) - quad.begin());
            lattice.boundary.emplace_back(quad[low], quad[(low + 1) % 4], quad[(low + 2) % 4]);
            lattice.boundary.emplace_back(quad[low], quad[(low + 2) % 4], quad[(low + 3) % 4]);
        }
    }
}

} // namespace

glm::ivec3 cornerOffset(int corner) {
    return {corner & 1, (corner >> 1) & 1, (corner >> 2) & 1};
}

bool octantHolds(int octant, int d) {
    const glm::ivec3& offset = kNeighbourOffsets[std::size_t(d)];
    for (int axis = 0; axis < 3; ++axis)
        if (offset[axis] != 0 && (offset[axis] > 0) != (((octant >> axis) & 1) != 0))
            return false;
    return true;
}

std::vector<std::int32_t> cellsAround(const Lattice& lattice) {
    std::vector<std::int32_t> cells(8 * lattice.nodeCount(), -1);
    for (std::size_t cell = 0; cell < lattice.cells.size(); ++cell)
        for (int corner = 0; corner < 8; ++corner) {
            // The cell lies towards -x of its corner at +x.
            const auto node = std::size_t(lattice.nodeAt(lattice.cells[cell].grid + cornerOffset(corner)));
            cells[8 * node + std::size_t(7 - corner)] = std::int32_t(cell);
        }
    return cells;
}

std::int64_t Lattice::nodeAt(const glm::ivec3& grid) const {
    if (glm::any(glm::lessThan(grid, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(grid, nodeDims)))
        return -1;
    return nodeOfGrid[gridIndex(grid, nodeDims)];
}

std::int64_t Lattice::neighbour(std::size_t node, int d) const {
    if (!((connections[node] >> d) & 1u))
        return -1;
    return nodeAt(nodes[node] + kNeighbourOffsets[std::size_t(d)]);
}

double Lattice::massShare(std::size_t node) const {
    int sum = 0;
    for (std::uint8_t fill : fills[node])
        sum += fill;
    return sum / (8.0 * 255.0);
}

double Lattice::springWeight(std::size_t node, int d) const {
    if (!((connections[node] >> d) & 1u))
        return 0;
    int sum = 0;
    for (int octant = 0; octant < 8; ++octant)
        if (octantHolds(octant, d))
            sum += fills[node][std::size_t(octant)];
    return sum / (255.0 * (d < 6 ? 4.0 : 2.0));
}

Lattice latticeFromCells(std::vector<LatticeCell> cells, double spacing, const glm::dvec3& origin) {
    SEROSA_CHECK(!cells.empty() && spacing > 0, "a lattice needs cells and a positive spacing");
    glm::ivec3 low = cells[0].grid, high = low;
    for (const LatticeCell& cell : cells) {
        low = glm::min(low, cell.grid);
        high = glm::max(high, cell.grid);
    }
    Lattice lattice;
    lattice.spacing = spacing;
    lattice.nodeDims = high - low + 2;
    lattice.centre = lattice.nodeDims / 2;
    // `origin` is where grid point (0, 0, 0) of the given cells lies; the lattice's own origin is its centre
    // node.
    lattice.origin = origin + spacing * glm::dvec3(low + lattice.centre);
    for (LatticeCell& cell : cells)
        cell.grid -= low;
    std::sort(cells.begin(), cells.end(), [](const LatticeCell& a, const LatticeCell& b) {
        return std::make_tuple(a.grid.z, a.grid.y, a.grid.x) < std::make_tuple(b.grid.z, b.grid.y, b.grid.x);
    });

    const glm::ivec3 cellDims = lattice.nodeDims - 1;
    std::vector<std::uint8_t> fillOfCell(
        std::size_t(cellDims.x) * std::size_t(cellDims.y) * std::size_t(cellDims.z), 0);
    lattice.nodeOfGrid.assign(std::size_t(lattice.nodeDims.x) * std::size_t(lattice.nodeDims.y) *
                                  std::size_t(lattice.nodeDims.z),
                              -1);
    for (const LatticeCell& cell : cells) {
        std::uint8_t& fill = fillOfCell[gridIndex(cell.grid, cellDims)];
        SEROSA_CHECK(cell.fill > 0 && fill == 0, "cells have a fill and are given once");
        fill = cell.fill;
        for (int corner = 0; corner < 8; ++corner)
            lattice.nodeOfGrid[gridIndex(cell.grid + cornerOffset(corner), lattice.nodeDims)] = 0;
    }
    lattice.cells = std::move(cells);

    for (int z = 0; z < lattice.nodeDims.z; ++z)
        for (int y = 0; y < lattice.nodeDims.y; ++y)
            for (int x = 0; x < lattice.nodeDims.x; ++x) {
                std::int32_t& index = lattice.nodeOfGrid[gridIndex({x, y, z}, lattice.nodeDims)];
                if (index < 0)
                    continue;
                index = std::int32_t(lattice.nodes.size());
                lattice.nodes.emplace_back(x, y, z);
                std::array<std::uint8_t, 8> around{};
                std::uint32_t bits = 0;
                for (int octant = 0; octant < 8; ++octant) {
                    const glm::ivec3 cell = glm::ivec3(x, y, z) + cornerOffset(octant) - 1;
                    if (glm::any(glm::lessThan(cell, glm::ivec3(0))) ||
                        glm::any(glm::greaterThanEqual(cell, cellDims)))
                        continue;
                    around[std::size_t(octant)] = fillOfCell[gridIndex(cell, cellDims)];
                    if (around[std::size_t(octant)] == 0)
                        continue;
                    for (int d = 0; d < 18; ++d)
                        if (octantHolds(octant, d))
                            bits |= 1u << d;
                }
                lattice.fills.push_back(around);
                lattice.connections.push_back(bits);
            }
    lattice.depthSteps = massDepths(lattice);
    addBoundary(lattice, fillOfCell);
    return lattice;
}

std::vector<glm::dvec3> restNormalSums(const Lattice& lattice) {
    std::vector<glm::dvec3> sums(lattice.nodeCount(), glm::dvec3(0));
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; ++d)
            if ((lattice.connections[node] >> d) & 1u)
                sums[node] -= glm::normalize(glm::dvec3(kNeighbourOffsets[std::size_t(d)]));
    return sums;
}

} // namespace serosa::sim
