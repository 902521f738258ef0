#pragma once
// The first stage of the mesher: marching tetrahedra over a body-centred cubic lattice.

#include "models/mesher.h"

namespace serosa::models {

/// Cuts the tetrahedra of a BCC lattice of cube edge `cell` (mm) by the zero set. Closed, manifold in edges
/// and vertices, and wound outward for any function: a lattice point counts as outside where the distance is
/// >= 0, and each cut edge has one vertex, kept 2% off the edge's ends so that no face is degenerate.
sim::TriangleMesh marchTetrahedra(const MeshSource& source, double cell);

/// Lattice points that marchTetrahedra would store.
double latticePoints(const MeshSource& source, double cell);

} // namespace serosa::models
