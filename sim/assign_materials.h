#pragma once
// Which cell is of which material: the regions of an organ applied to its lattice, and what came of it.

#include "base/result.h"
#include "sim/lattice.h"
#include "sim/material.h"
#include "sim/region.h"
#include "sim/triangle_mesh.h"

#include <functional>
#include <string>
#include <vector>

namespace serosa::sim {

/// Gives each cell the material of the last region that holds it; 0 where none does. A region of a place
/// holds a cell whose centre it contains. A layer holds a cell whose centre lies more than `from` and at most
/// `depth` below the surface (walls of cavities among it); one that begins at the surface holds all outermost
/// cells, those that the surface touches, however thin it is. A painted region holds cells in the same
/// way, but only those whose nearest point of the surface is painted: the vertex next to it has the colour.
/// \param metres the closed surface that the lattice was built from, m.
/// \param position what a message about a line of the scene begins with: "scene.toml:12: ".
/// Errors: a region that holds no cell, paint on a surface without colours.
Status assignMaterials(Lattice& lattice, const TriangleMesh& metres,
                       const std::vector<MaterialRegion>& regions,
                       const std::function<std::string(int line)>& position);

/// What the lattice holds of a material.
struct MaterialAmount {
    std::size_t cells = 0;
    double volume = 0; // m3, by the cells' fills
    double mass = 0;   // kg
};
/// One a material of the tissue.
std::vector<MaterialAmount> materialAmounts(const Lattice& lattice, const Tissue& tissue);

} // namespace serosa::sim
