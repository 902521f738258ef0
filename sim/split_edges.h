#pragma once
// A surface whose faces are larger than the lattice's cells can neither bend as the lattice does nor part
// along a cut: its long edges are split, for drawing. The solid stays what it is.

#include "sim/triangle_mesh.h"

namespace serosa::sim {

/// Splits edges in halves until none is longer than `longest` (unit of the positions, above 0). The old
/// vertices come first and stay where they are; colours, texture coordinates and normals of new ones lie
/// between those of their edge's ends, so that shading does not change either. A closed mesh stays closed.
/// \return true where an edge was split
bool splitLongEdges(TriangleMesh& mesh, double longest);

} // namespace serosa::sim
