#pragma once
// Strict readers for OBJ, PLY (ascii and both binary byte orders), OFF, STL (ascii and binary), legacy VTK
// POLYDATA (ascii and binary) and TetGen surfaces (.node beside .face).
// Nothing is repaired silently: each error says file, line or byte, what is wrong and what to do.

#include "base/result.h"
#include "sim/triangle_mesh.h"

#include <filesystem>

namespace serosa::sim {

/// Reads a surface, in the file's own unit, in the file's vertex order (STL: identical corner positions are
/// merged, in order of first use). Polygons are fanned. The format is taken from the content where it has a
/// magic, else from the extension; a mismatch is an error. Errors: missing, empty or truncated file, wrong
/// magic, NaN or infinite coordinates, index out of range, zero faces, counts larger than the file can hold,
/// decimal commas, trailing data.
/// Colours: PLY's uchar red green blue, OBJ's v x y z r g b, COFF. Passed over: normals, texture coordinates,
/// materials (their files are never opened), further PLY properties and elements, VTK's attributes, TetGen's
/// attributes and markers. Of TetGen's two files either may be named; the other one lies beside it. The
/// message starts with "FILE:LINE: " for text and "FILE: byte N: " for binary content. Whether the surface is
/// a closed solid: sim/mesh_check.h.
Result<TriangleMesh> readMesh(const std::filesystem::path& file);

} // namespace serosa::sim
