#pragma once
// How far each node has moved from rest, for other programs: a vector for each node of the whole grid, or a
// list of points. World frame (right-handed, y up), millimetres.

#include "base/result.h"
#include "sim/lattice.h"
#include "sim/lattice_state.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace serosa::sim {

/// One value a node of the grid nodeDims, x fastest.
struct DisplacementGrid {
    glm::ivec3 size{0};                // nodes along x, y, z
    double spacing = 0;                // mm, along each axis
    glm::dvec3 origin{0};              // mm: where the first node rests
    std::vector<glm::vec3> vectors;    // mm; zero where the lattice has no node
    std::vector<std::uint8_t> hasNode; // 1 or 0: tells a node at rest from none
};
DisplacementGrid displacementGrid(const Lattice& lattice, const LatticeState& state);

/// PLY, binary, little-endian: a vertex a node, in the lattice's order, with float64 x y z (rest) and
/// dx dy dz (displacement).
std::string displacementPly(const Lattice& lattice, const LatticeState& state);

} // namespace serosa::sim
