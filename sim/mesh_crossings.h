#pragma once
// Self-intersections: pairs of triangles that have a point in common beside the vertices and edges that they
// share.

#include "sim/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

/// True if the triangles abc and def have a point in common (touching counts). Exact for coordinates that
/// float32 holds; in float64 off by a rounding of 113 bits at most. Zero-area triangles are never said to
/// meet.
bool trianglesMeet(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
                   const glm::dvec3& e, const glm::dvec3& f);

/// True if two faces over the same vertices meet: at all where they share no vertex index, beyond the shared
/// vertex where they share one, folded onto each other where they share an edge. Faces of the same three
/// vertices meet.
bool facesMeet(const std::vector<glm::dvec3>& positions, glm::uvec3 first, glm::uvec3 second);

/// The number of pairs of faces that meet (facesMeet). Pairs of three shared vertices do not count.
std::uint64_t countCrossings(const TriangleMesh& mesh);

} // namespace serosa::sim
