#pragma once
// A unit normal in the 32 bits of a float32 alpha channel (MS05 3.2): octahedral, 15 bits a coordinate, twin
// of shaders/packed_normal.glsl. Bits 30 and 23 are fixed, so that the float is never NaN, infinite or
// denormal.

#include <glm/glm.hpp>

#include <cstdint>

namespace serosa::sim {

/// The bit pattern of the alpha channel. A zero vector packs as (0, 1, 0).
std::uint32_t packNormal(const glm::vec3& direction);
/// Unit normal, within 1.3e-4 rad of what was packed; along axes, face and space diagonals within float32
/// rounding.
glm::vec3 unpackNormal(std::uint32_t bits);

} // namespace serosa::sim
