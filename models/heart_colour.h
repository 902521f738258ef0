#pragma once
// Colours of the heart's surface, as fresh tissue looks: sRGB, mild large-scale variation, no texture.

#include "models/heart_anatomy.h"

namespace serosa::models {

/// Colour at a surface point p; `arteries` and `veins` are the distances to the coronary vessels.
glm::u8vec3 heartColour(const Point& p, const HeartAnatomy::Distances& d, double arteries, double veins);

} // namespace serosa::models
