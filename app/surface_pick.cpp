// See app/surface_pick.h. Moller and Trumbore, Fast, minimum storage ray/triangle intersection (1997).
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

std::optional<double> firstHit(const Ray& ray, const std::vector<glm::dvec3>& positions,
                               const std::vector<glm::uvec3>& faces) {
    std::optional<double> nearest;
    for (const glm::uvec3& face : faces) {
        const glm::dvec3& a = positions[face.x];
        const glm::dvec3 ab = positions[face.y] - a, ac = positions[face.z] - a;
        const glm::dvec3 p = glm::cross(ray.along, ac);
        const double facing = glm::dot(ab, p); // positive: the ray comes from outside
        if (!(facing > 0))
            continue;
        const glm::dvec3 from = ray.from - a, q = glm::cross(from, ab);
        const double u = glm::dot(from, p) / facing, v = glm::dot(ray.along, q) / facing;
        const double distance = glm::dot(ac, q) / facing;
        if (u >= 0 && v >= 0 && u + v <= 1 && distance >= 0 && (!nearest || distance < *nearest))
            nearest = distance;
    }
    return nearest;
}

glm::dvec3 onPlane(const Ray& ray, const glm::dvec3& point, const glm::dvec3& normal) {
    const double along = glm::dot(ray.along, normal), distance = glm::dot(point - ray.from, normal) / along;
    if (!std::isfinite(distance) || std::abs(along) < 1e-6 || distance < 0)
        return point;
    return ray.from + distance * ray.along;
}

} // namespace serosa::app
