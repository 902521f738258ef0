#pragma once
// How deep each node of a lattice rests below the organ's surface. Nodes of partly filled cells lie outside
// of it; a tool touches the surface, so contact needs to know by how much (sim/tool_motion.h).

#include "sim/lattice.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

class TriangleTree;

/// Depth in steps of 1/85 spacing from -2: 0 is two spacings outside, 170 on the surface, 255 one spacing or
/// more inside. `depth` in lattice units.
std::uint8_t depthStep(double depth);

/// Inside of a closed surface, wound outward: is the winding number along a ray not zero? \param reach longer
/// than from p to beyond all of the surface.
bool isInside(const TriangleTree& tree, const glm::dvec3& p, double reach);

/// By the distance to the surface (m, closed, wound outward, as the lattice was built from); one a node.
std::vector<std::uint8_t> surfaceDepths(const Lattice& lattice, const TriangleMesh& metres);

/// Where there is no surface: from a node's share of a full node's mass, right for a plane along the grid.
std::vector<std::uint8_t> massDepths(const Lattice& lattice);

} // namespace serosa::sim
