#pragma once
// Fills small holes of a surface with triangles over their boundary loops.
//
// This work is based on: Liepa 2003, Filling holes in meshes, section 3 (after Barequet & Sharir 1995): of
// all triangulations of the loop the one with the smallest largest dihedral angle, and of those the smallest
// area, by dynamic programming in O(n^3). Departures: angles are compared in steps of 1e-3 rad, so that
// rounding does not decide on flat holes; chords that are edges already are left out, so that no edge gets a
// third face; a filling that touches the surface is not taken, but the one of least area, or a fan around the
// loop's middle; no refinement and fairing, since the holes are small.

#include "sim/mesh_winding.h"
#include "sim/triangle_mesh.h"
#include "sim/triangle_tree.h"

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace serosa::sim {

class HoleFiller {
public:
    /// Keeps `mesh`, whose edges have one face or two that wind alike.
    explicit HoleFiller(TriangleMesh mesh);

    /// Appends faces, and at most one vertex, that close the hole; false if every filling would make a third
    /// face at an edge, a zero-area face, or touch a face. The loop is of three or more vertices, as
    /// boundaryLoops gives it.
    bool fill(const BoundaryLoop& loop);

    const TriangleMesh& mesh() const { return mesh_; }

private:
    using Faces = std::vector<glm::uvec3>;
    enum class Aim { angle, area };

    std::optional<Faces> triangulate(const BoundaryLoop& loop, Aim aim) const;
    Faces fan(const BoundaryLoop& loop, std::uint32_t middle) const;
    glm::dvec3 normalBeyond(std::uint32_t from, std::uint32_t to) const;
    bool hasEdge(std::uint32_t a, std::uint32_t b) const;
    bool fits(const Faces& faces) const;
    void add(const Faces& faces);

    TriangleMesh mesh_;
    std::size_t originalFaces_;
    TriangleTree tree_;                                       // of the original faces
    std::unordered_map<std::uint64_t, std::uint32_t> faceOf_; // of each half-edge (from, to)
};

} // namespace serosa::sim
