#pragma once
// From a signed distance function to triangles: marching tetrahedra, then collapse, flip and relax to a
// wanted number of well-shaped faces. One thread, fixed order: the same bytes on every run.

#include "base/result.h"
#include "models/sdf.h"
#include "sim/triangle_mesh.h"

#include <functional>

namespace serosa::models {

struct MeshSource {
    /// Signed distance, negative inside, gradient of length at most about 1.1.
    std::function<double(const Point&)> distance;
    /// A box that holds the shape.
    Point lowest, highest;
    /// No wall and no gap is thinner than this (mm): the first lattice is never so coarse as to miss one.
    double thinnest = 1e9;
    /// Relative edge length wanted at a point of the surface, about 0.4 to 2; empty: 1 everywhere.
    std::function<double(const Point&)> size;
};

/// The zero set of `source` as a closed 2-manifold, wound outward, vertices within 1e-6 of the zero set, with
/// `faces` faces rounded up to even. No colours. Errors: the grid that this needs is too large, or the shape
/// cannot be had with so few faces.
Result<sim::TriangleMesh> meshShape(const MeshSource& source, std::size_t faces);

} // namespace serosa::models
