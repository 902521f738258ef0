#pragma once
// The hand of CS07's figures: a right hand, open, cut flat at the wrist.

#include "models/solid.h"

namespace serosa::models {

/// Signed distance.
double handDistance(const Point& p);

/// Fingers up, palm towards +z, thumb towards +x; 188 mm from the crease of the wrist to the middle
/// finger's tip.
const Solid& handSolid();
Result<sim::TriangleMesh> makeHand(std::size_t faces);

} // namespace serosa::models
