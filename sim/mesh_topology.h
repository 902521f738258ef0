#pragma once
// Edges, fans and shells of a triangle soup: what is joined to what, and where it is no closed oriented
// manifold.

#include "sim/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

struct MeshTopology {
    struct Edge {
        std::uint32_t a, b; // vertices, as `face` winds them
        std::uint32_t face; // the lowest of its faces
    };

    std::vector<bool> degenerate;          // one a face: a repeated vertex, or an area of exactly zero
    std::vector<std::uint32_t> duplicates; // faces with the three vertices of an earlier one
    std::vector<Edge> openEdges;           // one face
    std::vector<Edge> nonManifoldEdges;    // more than two faces
    std::vector<Edge> inconsistentEdges;   // two faces that run along it the same way
    std::vector<std::uint32_t> nonManifoldVertices; // the faces around them form more than one fan
    std::vector<std::vector<std::uint32_t>>
        shellFaces; // faces of each edge-connected part, in order of first face
    std::size_t unusedVertices = 0;

    /// Each edge has two faces that wind alike, each vertex one fan, and no face is degenerate.
    bool closedManifold() const;
    /// Handles of a closed manifold shell: (2 - V + E - F) / 2.
    int genus(const TriangleMesh& mesh, std::size_t shell) const;
};

/// Faces with a repeated vertex take no part in edges, fans and shells. All lists are in ascending order of
/// vertex or face. Indices have to be in range (a broken promise otherwise).
MeshTopology findTopology(const TriangleMesh& mesh);

} // namespace serosa::sim
