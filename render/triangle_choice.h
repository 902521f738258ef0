#pragma once
// Which triangle of the lattice's boundary, or of other nodes, each vertex follows: the closest one that
// faces the same way, then a repair of the edges whose ends would follow unrelated parts of the lattice
// (MS05 3.3.1 leaves the choice open).

#include "render/control_nodes.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

/// The corner that begins the longest edge of a triangle: of a lattice's boundary, the diagonal of its face.
/// Bound from there, T of eq. 6 is the same line for both halves of a face, and tangential offsets agree
/// across it: on figure 6's bend that closes a third of the gaps that the corrected basis leaves.
int diagonalStart(const ControlNodes& control, const glm::uvec3& nodes);

struct VertexBinding;
/// Sets nodes and weights (in the order of the triangle, rounded to what the GPU has) of a vertex, and its
/// triangle. In render/surface_binding.cpp.
void followTriangle(VertexBinding& bound, std::uint32_t& triangle, const ControlNodes& nodes,
                    std::uint32_t chosen, const glm::dvec3& weights);

struct TriangleChoice {
    std::vector<std::uint32_t> triangles; // into those of the nodes, one a vertex
    std::vector<glm::dvec3> weights;      // of the reference point, eq. 4, in the order of the triangle
    std::size_t tornEdgesFound = 0, tornEdgesLeft = 0;
};

/// \param positions vertices at rest, in the unit of the nodes. \param normals of the mesh, unit. One a
/// vertex.
TriangleChoice chooseTriangles(const ControlNodes& control, const std::vector<glm::uvec3>& faces,
                               const std::vector<glm::dvec3>& positions,
                               const std::vector<glm::dvec3>& normals);

/// Repairs a given choice in place and counts: edges of the mesh whose ends' triangles share no node are
/// torn. Connected patches of vertices are bound anew, flooding in from their neighbours across torn edges,
/// where that leaves fewer torn edges.
void repairTornEdges(const ControlNodes& control, const std::vector<glm::uvec3>& faces,
                     const std::vector<glm::dvec3>& positions, TriangleChoice& choice);

} // namespace serosa::render
