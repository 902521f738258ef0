#pragma once
// What a mapping by triangles follows: nodes, triangles over them, and which nodes are neighbours. MS05 3.3:
// "The less detailed geometry can be as simple as a set of interconnected points": a lattice's boundary, or a
// surface that another solver or an animation moves.

#include "sim/lattice.h"
#include "sim/triangle_mesh.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::render {

struct ControlNodes {
    double spacing = 0;                // m: the unit of positions, about the length of an edge
    glm::dvec3 origin{0};              // m, world: where position 0 lies
    std::vector<glm::dvec3> rest;      // one a node
    std::vector<glm::uvec3> triangles; // over nodes, outward
    // Neighbours of node i: `neighbours` from neighbourBegin[i] to neighbourBegin[i + 1].
    std::vector<std::uint32_t> neighbourBegin, neighbours;
    // Normals of nodes are the mean of their triangles' (by area). Else eq. 3's, which a lattice gives almost
    // for free; but neighbours within a surface alone do not say where its outside is (3.5).
    bool normalsOfTriangles = false;

    std::size_t count() const { return rest.size(); }
    glm::dvec3 toNodes(const glm::dvec3& world) const { return (world - origin) / spacing; }
    glm::dvec3 toWorld(const glm::dvec3& p) const { return origin + spacing * p; } // m
};

/// Of a lattice, in lattice units. \param connections 18 bits a node, what cuts left; empty: the lattice's
ControlNodes controlNodes(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections = {});

/// Of a surface in metres: its vertices, joined by its edges. At least one edge that has a length.
ControlNodes controlNodes(const sim::TriangleMesh& metres);

/// What the GPU holds of such nodes: a lattice without springs or cells whose node i is node i here, with
/// these triangles as its boundary. Only its texture layout, place and boundary mean anything; its nodes do
/// not rest where these do.
sim::Lattice standInLattice(const ControlNodes& nodes);

/// The sums that node normals are the directions of: eq. 3's, or those of triangle areas.
/// \param positions one a node
std::vector<glm::dvec3> normalSums(const ControlNodes& nodes, const std::vector<glm::dvec3>& positions);

/// The same, packed as a solver writes them.
std::vector<std::uint32_t> packedNormals(const ControlNodes& nodes, const std::vector<glm::dvec3>& positions);

} // namespace serosa::render
