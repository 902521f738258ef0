#pragma once
// A camera that the user turns around a point: what `serosa view` does with mouse and keys. Pure mathematics;
// the result is a sim::Camera, which render/camera.h turns into matrices like that of any scene.

#include "sim/scene.h"

#include <glm/glm.hpp>

namespace serosa::app {

class OrbitCamera {
public:
    /// Starts at the scene's camera, framed on the bounds (m) as render::makeCamera frames them.
    /// \param aspect width / height of the picture
    OrbitCamera(const sim::Camera& scene, const glm::dvec3& lowest, const glm::dvec3& highest, double aspect);

    /// Distances of the pointer are in heights of the window, x to the right and y up.
    /// Turns the organ along: a window's height is half a turn. Stops short of looking straight along `up`.
    void orbit(const glm::dvec2& by);
    /// Moves the organ along: the point under the pointer, at the target's distance, stays under it.
    void pan(const glm::dvec2& by);
    /// Above 1: nearer. Limits: from 1/50 to 50 times the size of the bounds.
    void zoom(double factor);
    /// Back to the scene's camera.
    void reset();

    /// The scene's own camera, unchanged, until the user has moved it.
    const sim::Camera& settings() const { return settings_; }

private:
    void place();

    sim::Camera scene_, settings_;
    glm::dvec3 startTarget_{0}, startDirection_{0, 0, -1};
    double startDistance_ = 1, startHeight_ = 1; // m
    double size_ = 1;                            // m: diagonal of the bounds
    glm::dvec3 target_{0}, direction_{0, 0, -1}; // m; unit
    double distance_ = 1, height_ = 1;           // m: eye to target; extent of the window at the target
};

} // namespace serosa::app
