#pragma once
// How deep each node of a lattice rests below the organ's surface. Nodes of partly filled cells lie outside
// of it; a tool touches the surface, so contact needs to know by how much (sim/tool_motion.h).
//
// Contact keeps a node off the tool by its depth, so that nothing between the two is squeezed. That is right
// where a cell is filled by a small share s: it is as pliant as 1/s full ones, the tissue in it as s of one.
// Of a fuller cell it makes a rigid skin (10% too much force on a sphere that touches four cells across), so
// deeper nodes may come nearer: the first full cell under a tool is squeezed as tissue is, to 0.8 of its
// height. Without any hold on the nodes below, deep presses fold the cells.

#include "sim/lattice.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

class TriangleTree;

/// How near to a tool, in spacings, contact lets a node that rests `depth` spacings below the surface: as
/// deep to 0.6, then half of what is deeper, at most 1.
double contactDepth(double depth);

/// The depth of which `counted` is the contactDepth, at most 1.4: what is deeper counts as that.
double depthOfContact(double counted);

/// contactDepth in steps of 1/85 spacing from -2: 0 is two spacings outside, 170 on the surface, 255 for what
/// lies 1.4 spacings or more inside. `depth` in lattice units.
std::uint8_t depthStep(double depth);

/// Inside of a closed surface, wound outward: is the winding number along a ray not zero? \param reach longer
/// than from p to beyond all of the surface.
bool isInside(const TriangleTree& tree, const glm::dvec3& p, double reach);

/// By the distance to the surface (m, closed, wound outward, as the lattice was built from); one a node.
std::vector<std::uint8_t> surfaceDepths(const Lattice& lattice, const TriangleMesh& metres);

/// Where there is no surface: from a node's share of a full node's mass, right for a plane along the grid;
/// full ones lie a spacing deep beside those that are not, else deeper.
std::vector<std::uint8_t> massDepths(const Lattice& lattice);

} // namespace serosa::sim
