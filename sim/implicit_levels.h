#pragma once
// The coarser grids over a lattice that the implicit step's preconditioner works on
// (docs/methods/implicit.md): level 0 is the lattice; each further level has twice the spacing, on the same
// origin, and the nodes that trilinear interpolation to the level below it needs. The last one is small
// enough for a dense matrix. Shape alone: nothing here moves or knows a material.

#include "sim/lattice.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace serosa::sim {

struct ImplicitLevel {
    std::vector<glm::ivec3> nodes;                        // grid coordinates over 2^level
    std::vector<std::array<std::int32_t, 8>> cells;       // its corners (cornerOffset)
    std::vector<std::array<std::int32_t, 8>> cellsAround; // a node: the cell in each octant; -1: none

    /// A node: those of the next level that it takes a value from, each with the same weight, 1 over their
    /// number; -1: none. Empty on the last level.
    std::vector<std::array<std::int32_t, 8>> coarser;
    /// A node: those of the level below within one of its spacings, -1: none; at offset (x, y, z) of -1, 0,
    /// 1 in place x + 1 + 3 (y + 1 + 3 (z + 1)), with the weight finerWeight(). Empty on level 0.
    std::vector<std::array<std::int32_t, 27>> finer;
    /// A cell: the cells of the level below in its octants; -1: none. Empty on level 0.
    std::vector<std::array<std::int32_t, 8>> finerCells;
};

/// 1, 1/2, 1/4 or 1/8: of the finer node in a place of ImplicitLevel::finer.
double finerWeight(std::size_t place);

/// Gradient, in units of 1/spacing, of the trilinear function of a cell's corner at the middle of one of its
/// octants.
glm::dvec3 octantGradient(int corner, int octant);

/// At least two levels; the last has at most SRS_IMPLICIT_COARSEST nodes.
std::vector<ImplicitLevel> implicitLevels(const Lattice& lattice);

} // namespace serosa::sim
