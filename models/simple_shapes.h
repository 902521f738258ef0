#pragma once
// Phantoms whose shape is known exactly, for tests of mechanics: made directly, not by the mesher.

#include "base/result.h"
#include "sim/triangle_mesh.h"

namespace serosa::models {

constexpr double kBallRadius = 40; // mm

/// A box of `extent` about the origin with sharp edges, each side a grid of `cells` (at least 1) squares cut
/// in two.
sim::TriangleMesh makeGridBox(const glm::dvec3& extent, const glm::ivec3& cells);

/// 30 x 30 x 120 mm. Errors: no grid has between `faces` and 5% more.
Result<sim::TriangleMesh> makeBeam(std::size_t faces);

/// 120 x 48 x 120 mm: a layer that a sphere indents. Errors: 180 n^2 is not between `faces` and 5% more for
/// any n.
Result<sim::TriangleMesh> makeLayer(std::size_t faces);

/// Subdivided icosahedron of radius kBallRadius. Errors: 20 n^2 is not between `faces` and 5% more for any n.
Result<sim::TriangleMesh> makeBall(std::size_t faces);

} // namespace serosa::models
