#pragma once
// Mends what it names and nothing else, and only where it is asked to (--repair, `repair = true`): faces with
// a repeated corner, doubled faces, winding, small holes, stray vertices. All other faults are refused with
// the reason: it is better to have no organ than another one.

#include "base/result.h"
#include "sim/triangle_mesh.h"

#include <string>
#include <vector>

namespace serosa::sim {

/// A hole is filled if it is within both limits.
struct RepairLimits {
    std::size_t holeEdges = 128; // edges of its boundary loop
    double holeExtent = 0.2;     // diagonal of the loop's box, as a share of the mesh's
};

struct RepairReport {
    std::size_t repeatedCornerFaces = 0; // removed: two corners are one vertex
    std::size_t duplicateFaces = 0;      // removed: the three vertices of an earlier face
    std::size_t flippedFaces = 0;        // wound the other way now
    std::size_t turnedShells = 0;        // whole shells among them (inverted, or a cavity wound outward)
    std::size_t filledHoles = 0, addedFaces = 0, addedVertices = 0;
    std::size_t strayVertices = 0; // removed: no face used them

    bool changed() const;
    /// What was done, a line for each kind; empty where nothing was.
    std::vector<std::string> lines() const;
};

struct RepairedMesh {
    TriangleMesh mesh;
    RepairReport report;
};

/// The mended mesh is a closed solid (sim/mesh_check.h) with the original's vertices and faces in their
/// order, less those removed, new ones at the end. A face that was not wound wrongly keeps its three corners
/// as they stand, a vertex its place; a mesh without a fault comes back unchanged. Refused: holes beyond the
/// limits or whose filling would touch the surface, non-manifold edges and vertices, zero-area faces of three
/// different vertices, one-sided surfaces, several solids, an absurd size. Self-intersections of the original
/// stay. \param name what messages call the mesh.
Result<RepairedMesh> repairMesh(TriangleMesh mesh, const std::string& name, const RepairLimits& limits = {});

/// An error of checkClosedSolid, with a hint at --repair where repairMesh would mend the mesh.
Error withRepairHint(const Error& error, const TriangleMesh& mesh);

} // namespace serosa::sim
