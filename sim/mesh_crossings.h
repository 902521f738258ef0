#pragma once
// Self-intersections: pairs of triangles that share no vertex and have a point in common.

#include "sim/triangle_mesh.h"

#include <cstdint>

namespace serosa::sim {

/// True if the triangles abc and def have a point in common (touching counts). Exact for coordinates that
/// float32 holds; in float64 off by a rounding of 113 bits at most. Zero-area triangles are never said to
/// meet.
bool trianglesMeet(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
                   const glm::dvec3& e, const glm::dvec3& f);

/// The number of such pairs among triangles that share no vertex index.
std::uint64_t countCrossings(const TriangleMesh& mesh);

} // namespace serosa::sim
