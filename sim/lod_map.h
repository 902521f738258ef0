#pragma once
// Level of detail (MS05 3.6): what the nodes of one lattice of an organ are made of on another one with twice
// or half its spacing. Weights of displacements and velocities, found once from the rest positions. Grids are
// nested (LatticeRequest::gridPoint): a coarse cell is eight fine ones, a coarse node lies on a fine grid
// point.
//
// To finer: trilinear in the coarse cell that holds the fine node. To coarser: a displacement is that of the
// fine node at the same place, as the interpolation back wants it; a velocity is a mean over the fine nodes
// in the cells around, weighted by mass and by the same trilinear weights, and fitted (moving least squares:
// the value at the node of the affine field that is closest), so that turning and stretching bodies keep
// their motion at the border, where the fine nodes lie to one side. Coarse nodes outside of the fine
// lattice get the fit for both.

#include "sim/lattice.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

struct LodEntry {
    std::uint32_t node; // of the source
    float weight;
};

/// Rows of a sparse matrix; each sums to 1, and gives affine fields back.
struct LodRows {
    std::vector<std::uint32_t> starts; // one a target node, and the end
    std::vector<LodEntry> entries;
};

/// Eight entries a fine node, in the order of a cell's corners, zeros among them.
LodRows trilinearRows(const Lattice& coarse, const Lattice& fine);

/// Velocities of coarse nodes from fine ones. \param masses of the fine nodes, above 0
LodRows meanRows(const Lattice& fine, const std::vector<double>& masses, const Lattice& coarse);

/// Displacements of coarse nodes: the fine node at the same place, or the row of `means` where none is.
LodRows placeRows(const Lattice& fine, const LodRows& means, const Lattice& coarse);

} // namespace serosa::sim
