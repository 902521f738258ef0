#pragma once
// Writes surfaces: small writers of our own, under a temporary name that is renamed when complete.
//
// Not through OpenMesh (9.0, Debian 12), though it is at hand: from a mesh of doubles its PLY writer stores
// float32, its OBJ writer six fixed decimals (1e-7 becomes 0), all print to the terminal, a full disk is not
// told from success, and its half-edges refuse surfaces that are not manifold, such as one that a cut has
// opened.

#include "base/result.h"
#include "sim/triangle_mesh.h"

#include <filesystem>

namespace serosa::sim {

/// Writes by extension: .ply (binary little-endian, float64 coordinates), .obj, .off (text that reads back to
/// the same float64), .stl (binary, float32). Colours, if any, go to all but STL. Vertex and face order are
/// kept (STL has no vertices); unused vertices too. Errors: unknown extension, no faces, a coordinate that is
/// not finite (or too large for STL's float32), folder missing, disk full; on error nothing is left under the
/// final name.
Status writeMesh(const TriangleMesh& mesh, const std::filesystem::path& file);

} // namespace serosa::sim
