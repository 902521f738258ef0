#pragma once
// The fish of CS07's figures: a perch.

#include "models/solid.h"

namespace serosa::models {

/// Signed distance; mirror-symmetric about z = 0.
double fishDistance(const Point& p);

/// A perch of 186 mm, head towards -x, fins spread.
const Solid& fishSolid();
Result<sim::TriangleMesh> makeFish(std::size_t faces);

} // namespace serosa::models
