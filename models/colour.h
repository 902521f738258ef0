#pragma once
// Mixing of vertex colours: sRGB, 0 to 255, as doubles until the end.

#include <glm/glm.hpp>

namespace serosa::models {

using Colour = glm::dvec3;

/// From a (t = 0) to b (t = 1).
inline Colour mix(const Colour& a, const Colour& b, double t) {
    return a + (b - a) * t;
}

inline glm::u8vec3 toBytes(const Colour& colour) {
    return glm::u8vec3(glm::clamp(glm::round(colour), 0.0, 255.0));
}

} // namespace serosa::models
