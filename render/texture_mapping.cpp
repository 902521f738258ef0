// See render/texture_mapping.h.
#include "render/texture_mapping.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::render {

glm::dvec3 TextureMapping::toTexture(const glm::dvec3& object) const {
    const glm::dvec3 local(glm::inverse(objectFromLocal) * glm::dvec4(object, 1));
    if (!(cylinderRadius > 0))
        return local;
    return {std::hypot(local.x, local.z) - cylinderRadius, local.y,
            cylinderRadius * std::atan2(local.z, local.x)};
}

glm::dvec3 TextureMapping::toObject(const glm::dvec3& texture) const {
    glm::dvec3 local = texture;
    if (cylinderRadius > 0) {
        const double r = texture.x + cylinderRadius, phi = texture.z / cylinderRadius;
        local = {r * std::cos(phi), texture.y, r * std::sin(phi)};
    }
    return glm::dvec3(objectFromLocal * glm::dvec4(local, 1));
}

glm::dmat3 TextureMapping::jacobian(const glm::dvec3& texture) const {
    glm::dmat3 local(1);
    if (cylinderRadius > 0) {
        const double phi = texture.z / cylinderRadius, share = texture.x / cylinderRadius + 1;
        local[0] = {std::cos(phi), 0, std::sin(phi)};
        local[2] = {-share * std::sin(phi), 0, share * std::cos(phi)};
    }
    return glm::dmat3(objectFromLocal) * local;
}

Bounds TextureMapping::boundsOf(const glm::dvec3& half) const {
    constexpr int kSamples = 16;
    Bounds bounds;
    bounds.lowest = glm::dvec3(std::numeric_limits<double>::infinity());
    bounds.highest = -bounds.lowest;
    for (int z = 0; z <= kSamples; ++z)
        for (int y = 0; y <= kSamples; ++y)
            for (int x = 0; x <= kSamples; ++x) {
                const glm::dvec3 q = (2.0 * glm::dvec3(x, y, z) / double(kSamples) - 1.0) * half;
                bounds.lowest = glm::min(bounds.lowest, toObject(q));
                bounds.highest = glm::max(bounds.highest, toObject(q));
            }
    return bounds;
}

} // namespace serosa::render
