#pragma once
// What lies under the pointer: rays of a camera, and where they meet a surface.

#include "render/camera.h"

#include <glm/glm.hpp>

#include <optional>
#include <vector>

namespace serosa::app {

struct Ray {
    glm::dvec3 from{0};         // m, world
    glm::dvec3 along{0, 0, -1}; // unit
};

/// \param at from the window's top left corner, y down; \param size of the window, in the same units
Ray rayThrough(const render::CameraView& camera, const glm::dvec2& at, const glm::dvec2& size);

/// Where the ray first meets the front of a face, as a distance along it in m; nothing where it misses.
std::optional<double> firstHit(const Ray& ray, const std::vector<glm::dvec3>& positions,
                               const std::vector<glm::uvec3>& faces);

/// Where the ray meets the plane through `point`; `point` itself where it runs along the plane or away.
glm::dvec3 onPlane(const Ray& ray, const glm::dvec3& point, const glm::dvec3& normal);

} // namespace serosa::app
