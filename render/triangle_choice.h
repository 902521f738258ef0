#pragma once
// Which boundary triangle of the lattice each vertex follows: the closest one that faces the same way, then a
// repair of the edges whose ends would follow unrelated parts of the lattice (MS05 3.3.1 leaves the choice
// open).

#include "sim/lattice.h"
#include "sim/triangle_mesh.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

/// The corner that begins the longest edge of a boundary triangle (nodes of lattice.boundary): the diagonal
/// of its face. Bound from there, T of eq. 6 is the same line for both halves of a face, and tangential
/// offsets agree across it: on figure 6's bend that closes a third of the gaps that the corrected basis
/// leaves.
int diagonalStart(const sim::Lattice& lattice, const glm::uvec3& nodes);

struct TriangleChoice {
    std::vector<std::uint32_t> triangles; // into lattice.boundary, one a vertex
    std::vector<glm::dvec3> weights;      // of the reference point, eq. 4, in the order of lattice.boundary
    std::size_t tornEdgesFound = 0, tornEdgesLeft = 0;
};

/// \param positions vertices at rest, lattice units. \param normals of the mesh, unit. One a vertex.
TriangleChoice chooseTriangles(const sim::Lattice& lattice, const std::vector<glm::uvec3>& faces,
                               const std::vector<glm::dvec3>& positions,
                               const std::vector<glm::dvec3>& normals);

/// Repairs a given choice in place and counts: edges of the mesh whose ends' triangles share no node are
/// torn. Connected patches of vertices are bound anew, flooding in from their neighbours across torn edges,
/// where that leaves fewer torn edges.
void repairTornEdges(const sim::Lattice& lattice, const std::vector<glm::uvec3>& faces,
                     const std::vector<glm::dvec3>& positions, TriangleChoice& choice);

} // namespace serosa::render
