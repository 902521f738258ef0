#pragma once
// Cameras: scene settings framed on an organ, as matrices. Right-handed, y up; the view looks along -z of the
// camera.

#include "sim/scene.h"

#include <glm/glm.hpp>

namespace serosa::render {

struct CameraView {
    glm::dmat4 cameraFromWorld{1};
    glm::dmat4 clipFromCamera{1};
    glm::dvec3 eye{0}; // m, world
};

/// \param lowest, highest bounds to frame where the scene gives no eye or height, m. \param aspect width /
/// height.
CameraView makeCamera(const sim::Camera& settings, const glm::dvec3& lowest, const glm::dvec3& highest,
                      double aspect);

/// The camera carried around the upright axis through a point (m, world) by an angle, rad: it looks at the
/// same things from another side.
CameraView carriedAround(const CameraView& camera, const glm::dvec3& middle, double angle);

} // namespace serosa::render
