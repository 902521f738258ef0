#pragma once
// Strict readers for OBJ, PLY (ascii and both binary byte orders), OFF and STL (ascii and binary).
// Nothing is repaired silently: each error says file, line or byte, what is wrong and what to do.

#include <filesystem>

#include "base/result.h"
#include "sim/triangle_mesh.h"

namespace serosa::sim {

/// Reads a surface, in the file's own unit, in the file's vertex order (STL: identical corner positions are merged, in
/// order of first use). Polygons are fanned. The format is taken from the content where it has a magic, else from the
/// extension; a mismatch is an error. Errors: missing, empty or truncated file, wrong magic, NaN or infinite
/// coordinates, index out of range, zero faces, counts larger than the file can hold, decimal commas, trailing data.
Result<TriangleMesh> readMesh(const std::filesystem::path& file);

} // namespace serosa::sim
