#pragma once
// The apple, for the cuts and deformations of CS07's figures 2 and 6.

#include "models/solid.h"

namespace serosa::models {

/// What a cut shows (CS07, figure 6): flesh all through; a skin of kHollowWall; a shell of kThickWall.
enum class AppleKind { solid, hollow, thick };

constexpr double kHollowWall = 2.0, kThickWall = 12.0; // mm, under the outer surface

/// Signed distance; the wall of the hollow kinds has its thickness everywhere under the body's surface.
double appleDistance(const Point& p, AppleKind kind = AppleKind::solid);

/// Body, stem and calyx; the hollow kinds have a second surface inside.
const Solid& appleSolid(AppleKind kind = AppleKind::solid);
Result<sim::TriangleMesh> makeApple(std::size_t faces);

} // namespace serosa::models
