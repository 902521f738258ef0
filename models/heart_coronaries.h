#pragma once
// Coronary vessels, laid onto the outer surface of the heart's muscle where the grooves are.

#include "models/heart_anatomy.h"

namespace serosa::models {

struct Coronaries {
    TubeTree arteries, veins;
    static constexpr double kFillet =
        1.2; // mm, blend radius between a vessel and the surface that it lies on
};

/// Left anterior descending, circumflex and right coronary arteries with branches, and the great, middle and
/// small cardiac veins beside them.
Coronaries layCoronaries(const HeartAnatomy& heart);

} // namespace serosa::models
