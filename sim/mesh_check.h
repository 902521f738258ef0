#pragma once
// Is a triangle soup a closed surface that has an inside? What `serosa inspect` prints and `serosa run`
// insists on.

#include "base/result.h"
#include "sim/triangle_mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace serosa::sim {

struct MeshReport {
    std::size_t vertices = 0, faces = 0;
    std::size_t unusedVertices = 0, degenerateFaces = 0, duplicateFaces = 0;
    std::size_t openEdges = 0, nonManifoldEdges = 0, nonManifoldVertices = 0, inconsistentEdges = 0;
    std::size_t shells = 0;      // edge-connected components
    std::size_t solids = 0;      // shells that bound material from outside (wound outward)
    std::size_t cavities = 0;    // shells nested in a solid, wound inward
    std::vector<int> genus;      // one a shell; empty if open
    double volume = 0, area = 0; // file units
    glm::dvec3 lowest{0}, highest{0};
    std::uint64_t selfIntersections = 0; // pairs of crossing or overlapping faces; counted only if asked
};

/// Counts everything of MeshReport (never fails). Self-intersections cost a tree of faces.
MeshReport inspectMesh(const TriangleMesh& mesh, bool countSelfIntersections);

/// Refuses what has no inside, naming the first offending vertex or face: open edges, non-manifold edges,
/// inconsistent or inverted winding, doubled faces, pinched vertices, zero-area faces, several solids, absurd
/// size (an extent below 1e-9 or above 1e9 file units, further than that from the origin, not finite, or zero
/// volume). Nested cavities and a few self-intersections pass. \param name what to call the mesh in the
/// message: its file name.
Status checkClosedSolid(const TriangleMesh& mesh, const std::string& name);

} // namespace serosa::sim
