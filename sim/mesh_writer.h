#pragma once
// Writes surfaces (through OpenMesh), under a temporary name that is renamed when complete.

#include <filesystem>

#include "base/result.h"
#include "sim/triangle_mesh.h"

namespace serosa::sim {

/// Writes by extension: .ply (binary little-endian, float64 coordinates, colours if any), .obj, .off, .stl.
/// Vertex and face order are kept (STL has none). Errors: unknown extension, folder missing, disk full; on error
/// nothing is left under the final name.
Status writeMesh(const TriangleMesh& mesh, const std::filesystem::path& file);

} // namespace serosa::sim
