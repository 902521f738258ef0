#pragma once
// Which faces wind against their neighbours, and the boundary loops of the holes that are left when they do
// not: the two questions that a repair asks of a surface whose edges have at most two faces.

#include "base/result.h"
#include "sim/triangle_mesh.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace serosa::sim {

/// One flag a face: flip it, and all neighbours of an edge-connected part wind alike. In each part the fewer
/// faces are flipped; of equally many, those that the part's first face is not among. Empty if a part is
/// one-sided, as a Moebius strip is. No edge may have more than two faces, no face a repeated corner.
std::optional<std::vector<bool>> facesToFlip(const TriangleMesh& mesh);

/// Vertices of a hole's boundary, in the direction in which a face that fills it winds.
using BoundaryLoop = std::vector<std::uint32_t>;

/// All holes of a consistently wound surface, in order of their lowest vertex, which comes first in its loop.
/// Where two holes touch in a vertex, each loop passes from one fan of faces to the other.
/// Errors: a vertex that a loop visits twice, or where more than two holes meet. \param name for messages.
Result<std::vector<BoundaryLoop>> boundaryLoops(const TriangleMesh& mesh, const std::string& name);

} // namespace serosa::sim
