#pragma once
// The heart phantom: see docs/phantoms.md for what it shows and how its parts were made.

#include "base/result.h"
#include "sim/triangle_mesh.h"

#include <string>
#include <vector>

namespace serosa::models {

/// A place where a wall's thickness is known: from `outerPoint`, on the outer surface, the way `inward`
/// (unit) leaves the wall on its other face after `expected` millimetres. In the frame of
/// makePhantom("heart").
struct WallProbe {
    std::string wall; // "left ventricle", "right ventricle", "left atrium", "right atrium", "aorta", ...
    glm::dvec3 outerPoint, inward;
    double expected; // mm
};
std::vector<WallProbe> heartWallProbes();

/// A point inside each lumen: the four chambers, aorta, pulmonary trunk. In the frame of
/// makePhantom("heart").
struct HeartLumen {
    std::string name;
    glm::dvec3 inside;
};
std::vector<HeartLumen> heartLumens();

/// A plane through the apex and all four chambers: a point of it and its unit normal (towards the viewer).
struct HeartSection {
    glm::dvec3 on, normal;
};
HeartSection heartFourChamberSection();

/// Signed distance of the whole heart (negative in its material), in the frame of makePhantom("heart").
double heartDistance(const glm::dvec3& p);

/// Extent of the muscle (ventricles and atria, without vessels) along its long axis, apex to base, in mm.
double heartMuscleLength();

/// The mesh, with colours; see makePhantom.
Result<sim::TriangleMesh> makeHeart(std::size_t faces);

} // namespace serosa::models
