#pragma once
// The dragon-like phantom, for MS05's figure 6.

#include "base/result.h"
#include "sim/triangle_mesh.h"

namespace serosa::models {

/// A curled dragon within 120 x 120 x 60 mm. Errors: a count that the shape cannot have.
Result<sim::TriangleMesh> makeDragon(std::size_t faces);

} // namespace serosa::models
