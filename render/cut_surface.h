#pragma once
// The detailed surface along cuts that a mask knows (render/cut_mask.h): a face that a cut crosses is drawn
// once for each side, all of its vertices carried by that side alone, and the mask takes from each copy what
// lies on the other side or in the cut. So nothing is stretched across a gap, and the lips are as smooth as
// the mask.
//
// Beside a cut vertices ride in the cell that they rest in, whatever the mapping, with the corners where
// their side has them (render/side_nodes.h): triangles of the boundary turn away from each other there, and
// where a lip is bent hard a vertex that keeps its offset from one would leave a jagged edge. Farther than a
// cell from the cut the mapping takes over, within about a spacing and without a step.
//
// Tears sweep nothing: there a face is drawn once for each side that its vertices' nodes go with, all of it,
// with vertices that belong to another side on the closest triangle of this one. So neither side has a hole,
// and each goes on by less than a face beyond the tear.

#include "render/surface_binding.h"
#include "sim/lattice.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace serosa::render {

/// A vertex as one side of a cut carries it.
struct CutVertex {
    std::uint32_t vertex = 0;                // of the mesh
    int side = 0;                            // 1 or -1; 0: of a tear, which has no sides in space
    std::optional<FollowedTriangle> follows; // instead of its own, on the side of a tear
    float share = 0;                         // of its cell in where it lies; the rest is the mapping's
    double away = 0; // from the nearest cut, spacings, by the nodes around; the sign is the side; 0: unknown
};

struct CutSurface {
    std::vector<bool> whole;           // one flag a face of the mesh: drawn as it is
    std::vector<float> shares;         // of the cell, one a vertex of the mesh; empty: no blade cut
    std::vector<CutVertex> vertices;   // of the copies
    std::vector<glm::uvec3> copies;    // faces over `vertices`
    std::vector<std::uint32_t> copied; // the mesh face of each
};

/// \param uncut as it was bound without cuts. \param connections 18 bits a node. \param sides signed
/// distances of the nodes to the nearest cut, spacings (CutMask::nodeSides), or empty: no blade cut, and
/// faces that springs no longer hold (facesLeft) are those of tears. In cells those are left out.
CutSurface cutSurface(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                      const SurfaceBinding& uncut, const SurfaceBinding& binding,
                      const std::vector<std::uint32_t>& connections, const std::vector<float>& sides);

} // namespace serosa::render
