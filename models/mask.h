#pragma once
// The mask that CS07 lays under the skin of the torso (figure 1b): a face, thin and hollow behind.

#include "models/solid.h"

namespace serosa::models {

constexpr double kMaskWall = 4.0; // mm

/// Signed distance, in the frame of makePhantom("torso").
double maskDistance(const Point& p);

/// One solid with two openings for the eyes, inside the torso's chest, facing +z.
const Solid& maskSolid();
Result<sim::TriangleMesh> makeMask(std::size_t faces);

} // namespace serosa::models
