#pragma once
// How a state has deformed the lattice's cells. The mean deformation gradient F of a cell drives its
// volumetric term (sim/volume_term.h); its determinant J is the cell's volume over its rest volume, below
// zero where the cell has turned inside out, which springs alone do not undo.

#include "sim/lattice.h"
#include "sim/lattice_state.h"

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::sim {

/// Nodes of a cell; corner c lies at +x if c & 1, +y if c & 2, +z if c & 4.
using CellCorners = std::array<std::uint32_t, 8>;
CellCorners cornersOf(const Lattice& lattice, const LatticeCell& cell);
/// (+-1, +-1, +-1) of corner c: four times the gradient of trilinear interpolation at the cell's centre.
inline glm::dvec3 cornerSign(int corner) {
    return {corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1};
}
/// The directions of the 18 that stay inside a cell from its corner c: 3 edges and 3 face diagonals.
std::uint32_t directionsInCell(int corner);
/// F = sum over the corners c of x_c (cornerSign(c)/4)^T, x in lattice units. Columns dx/dX, dx/dY, dx/dZ.
glm::dmat3 meanGradient(const CellCorners& corners, const std::vector<glm::dvec3>& x);

/// J = det F of each material cell, in the order of lattice.cells.
std::vector<double> cellVolumeRatios(const Lattice& lattice, const LatticeState& state);

/// Cells with J <= 0.
std::size_t invertedCells(const Lattice& lattice, const LatticeState& state);

} // namespace serosa::sim
