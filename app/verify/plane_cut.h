#pragma once
// The part of a closed surface above a horizontal plane, with edges along the plane: a solid that is held
// there can then be meshed with a face in the plane.

#include "base/result.h"
#include "sim/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace serosa::app {

struct PlaneCut {
    sim::TriangleMesh whole; // the closed surface; vertices close to the plane were moved onto it
    sim::TriangleMesh above; // its part above the plane, open at the loops; no colours
    std::vector<std::vector<std::uint32_t>> loops; // vertices of `above` around the openings, all at `height`
    std::vector<std::int64_t> sources;             // of each vertex of `above`: its vertex of `whole`, or -1
    double height = 0;
    /// Of what lies above the plane, cubic units of the positions.
    double volume() const;
};

/// Cuts at y = height. A vertex closer to the plane than a sixth of its shortest edge is moved onto it, so
/// that no sliver arises. Errors: the plane misses the surface, or touches it in a single point.
Result<PlaneCut> cutAbove(const sim::TriangleMesh& closed, double height);

} // namespace serosa::app
