// See app/orbit_camera.h.

#include "app/orbit_camera.h"

#include "render/camera.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace serosa::app {

namespace {

constexpr double kTurnAWindow = std::numbers::pi;             // rad a window's height
constexpr double kNearestPole = 2 * std::numbers::pi / 180;   // rad: least angle between view and up
constexpr double kNearestZoom = 1.0 / 50, kFarthestZoom = 50; // of the bounds' size

glm::dvec3 turned(const glm::dvec3& v, double angle, const glm::dvec3& axis) {
    return glm::angleAxis(angle, axis) * v;
}

/// Unit, across the view; any axis across where view and up are parallel.
glm::dvec3 rightOf(const glm::dvec3& direction, const glm::dvec3& up) {
    const glm::dvec3 right = glm::cross(direction, up);
    if (glm::length(right) > 1e-9)
        return glm::normalize(right);
    return glm::normalize(
        glm::cross(direction, std::abs(direction.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1)));
}

} // namespace

OrbitCamera::OrbitCamera(const sim::Camera& scene, const glm::dvec3& lowest, const glm::dvec3& highest,
                         double aspect)
    : scene_(scene), size_(std::max(glm::length(highest - lowest), 1e-9)) {
    const render::CameraView view = render::makeCamera(scene, lowest, highest, aspect);
    startTarget_ = scene.target.value_or(0.5 * (lowest + highest));
    const glm::dvec3 forward(glm::transpose(view.cameraFromWorld) * glm::dvec4(0, 0, -1, 0));
    startDirection_ = glm::normalize(forward);
    startDistance_ = std::max(glm::length(startTarget_ - view.eye), 1e-3 * size_);
    startHeight_ = 2 / view.clipFromCamera[1][1]; // orthographic; per metre of distance in perspective
    if (scene.projection == sim::Projection::perspective)
        startHeight_ *= startDistance_;
    reset();
}

void OrbitCamera::reset() {
    target_ = startTarget_;
    direction_ = startDirection_;
    distance_ = startDistance_;
    height_ = startHeight_;
    settings_ = scene_;
}

void OrbitCamera::place() {
    settings_.target = target_;
    settings_.eye = target_ - distance_ * direction_;
    if (settings_.projection == sim::Projection::orthographic)
        settings_.height = height_;
}

void OrbitCamera::orbit(const glm::dvec2& by) {
    const glm::dvec3 up = glm::normalize(scene_.up);
    // The picture turns with the pointer, so the eye goes the other way.
    direction_ = turned(direction_, -kTurnAWindow * by.x, up);
    const double fromUp = std::acos(std::clamp(glm::dot(direction_, up), -1.0, 1.0));
    const double wanted =
        std::clamp(fromUp - kTurnAWindow * by.y, kNearestPole, std::numbers::pi - kNearestPole);
    direction_ = glm::normalize(turned(direction_, fromUp - wanted, rightOf(direction_, up)));
    place();
}

void OrbitCamera::pan(const glm::dvec2& by) {
    const glm::dvec3 right = rightOf(direction_, glm::normalize(scene_.up));
    const glm::dvec3 up = glm::cross(right, direction_);
    target_ -= height_ * (by.x * right + by.y * up);
    place();
}

void OrbitCamera::zoom(double factor) {
    const double wanted = std::clamp(height_ / factor, kNearestZoom * size_, kFarthestZoom * size_);
    if (scene_.projection == sim::Projection::perspective)
        distance_ *= wanted / height_;
    height_ = wanted;
    place();
}

} // namespace serosa::app
