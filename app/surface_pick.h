#pragma once
// Rays of a camera through the pointer, and planes that they are dragged in.

#include "render/camera.h"

#include <glm/glm.hpp>

namespace serosa::app {

struct Ray {
    glm::dvec3 from{0};         // m, world
    glm::dvec3 along{0, 0, -1}; // unit
};

/// \param at from the window's top left corner, y down; \param size of the window, in the same units
Ray rayThrough(const render::CameraView& camera, const glm::dvec2& at, const glm::dvec2& size);

/// Where the ray meets the plane through `point`; `point` itself where it runs along the plane or away.
glm::dvec3 onPlane(const Ray& ray, const glm::dvec3& point, const glm::dvec3& normal);

} // namespace serosa::app
