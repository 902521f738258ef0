// See app/surface_pick.h.
#include "app/surface_pick.h"

#include <cmath>

namespace serosa::app {

Ray rayThrough(const render::CameraView& camera, const glm::dvec2& at, const glm::dvec2& size) {
    const glm::dvec2 clip(2 * at.x / size.x - 1, 1 - 2 * at.y / size.y);
    const glm::dmat4 worldFromClip = glm::inverse(camera.clipFromCamera * camera.cameraFromWorld);
    const auto unproject = [&](double depth) {
        const glm::dvec4 p = worldFromClip * glm::dvec4(clip, depth, 1);
        return glm::dvec3(p) / p.w;
    };
    const glm::dvec3 near = unproject(-1);
    return {near, glm::normalize(unproject(1) - near)};
}

glm::dvec3 onPlane(const Ray& ray, const glm::dvec3& point, const glm::dvec3& normal) {
    const double along = glm::dot(ray.along, normal), distance = glm::dot(point - ray.from, normal) / along;
    if (!std::isfinite(distance) || std::abs(along) < 1e-6 || distance < 0)
        return point;
    return ray.from + distance * ray.along;
}

} // namespace serosa::app
