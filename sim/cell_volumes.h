#pragma once
// How a state has deformed the lattice's cells: the determinant J of a cell's mean deformation gradient is
// its volume over its rest volume; below zero the cell has turned inside out, which springs alone do not
// undo.

#include "sim/lattice.h"
#include "sim/lattice_state.h"

#include <vector>

namespace serosa::sim {

/// J of each material cell, in the order of lattice.cells: det F with F = sum over the corners c of x_c
/// g_c^T, g_c = (+-1, +-1, +-1)/4 in lattice units (the gradient of trilinear interpolation at the cell's
/// centre).
std::vector<double> cellVolumeRatios(const Lattice& lattice, const LatticeState& state);

/// Cells with J <= 0.
std::size_t invertedCells(const Lattice& lattice, const LatticeState& state);

} // namespace serosa::sim
