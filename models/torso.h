#pragma once
// The torso whose skin CS07 peels off the chest (figure 1b): a man's trunk with stumps of neck and arms.

#include "models/solid.h"

namespace serosa::models {

/// Signed distance; mirror-symmetric about x = 0.
double torsoDistance(const Point& p);

/// Chest towards +z; from the hips, cut flat, to the neck, 600 mm.
const Solid& torsoSolid();
Result<sim::TriangleMesh> makeTorso(std::size_t faces);

} // namespace serosa::models
