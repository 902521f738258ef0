#pragma once
// The kidney phantom: a right kidney seen from the front, hilum towards +x.

#include "models/solid.h"

namespace serosa::models {

/// Signed distance of the kidney's body alone, hilum carved, without vessels, pelvis and fat.
double kidneyBodyDistance(const Point& p);

/// Body with the stumps of renal vein (front), artery and ureter.
const Solid& kidneySolid();
Result<sim::TriangleMesh> makeKidney(std::size_t faces);

} // namespace serosa::models
