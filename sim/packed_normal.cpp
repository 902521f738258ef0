// MS05 3.2: normals in the alpha channel. Line by line the twin of shaders/packed_normal.glsl, in float32 as
// there.
#include "sim/packed_normal.h"

#include "shaders/shared_constants.h"

#include <cmath>

namespace serosa::sim {

namespace {
constexpr float kHalf = float(SRS_NORMAL_HALF_STEPS);

float signOf(float x) {
    return x >= 0 ? 1.0F : -1.0F;
}
} // namespace

std::uint32_t packNormal(const glm::vec3& direction) {
    const float sum = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    const glm::vec3 n = sum > 0 ? direction / sum : glm::vec3(0, 1, 0);
    glm::vec2 e(n);
    if (n.z < 0)
        e = {(1 - std::abs(n.y)) * signOf(n.x), (1 - std::abs(n.x)) * signOf(n.y)};
    const auto qx = std::uint32_t(std::floor(e.x * kHalf + (kHalf + 0.5F)));
    const auto qy = std::uint32_t(std::floor(e.y * kHalf + (kHalf + 0.5F)));
    const std::uint32_t data = qx | qy << 15;
    return (data & 0x7fffffU) | 0x800000U | (data & 0x1f800000U) << 1 | (data & 0x20000000U) << 2;
}

glm::vec3 unpackNormal(std::uint32_t bits) {
    const std::uint32_t data = (bits & 0x7fffffU) | (bits >> 1 & 0x1f800000U) | (bits >> 2 & 0x20000000U);
    const float ex = (float(data & 0x7fffU) - kHalf) * (1 / kHalf);
    const float ey = (float(data >> 15) - kHalf) * (1 / kHalf);
    glm::vec3 n(ex, ey, 1 - std::abs(ex) - std::abs(ey));
    const float fold = std::fmax(-n.z, 0.0F);
    n.x -= signOf(n.x) * fold;
    n.y -= signOf(n.y) * fold;
    return glm::normalize(n);
}

} // namespace serosa::sim
