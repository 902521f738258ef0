#pragma once
// The second stage of the mesher: fewer, better-shaped faces on the same zero set.

#include "models/mesher.h"

namespace serosa::models {

/// Collapses the shortest edges (relative to source.size) of the closed manifold `mesh` until at most `faces`
/// faces are left or none may go, flips and relaxes between, and puts every vertex onto the zero set. Each
/// step keeps the surface a manifold (link condition) and each face turned the way the distance's gradient
/// points at its corners, so that no face folds over a neighbour. May stop up to 1% above `faces`, or further
/// where nothing more can go.
sim::TriangleMesh remesh(const sim::TriangleMesh& mesh, const MeshSource& source, std::size_t faces);

} // namespace serosa::models
