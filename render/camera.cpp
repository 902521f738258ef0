#include "render/camera.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace serosa::render {

namespace {

constexpr double kMargin = 1.1; // of the framed extent

struct Axes {
    glm::dvec3 right, up, forward;
};

Axes axesOf(const glm::dvec3& direction, const glm::dvec3& wantedUp) {
    const glm::dvec3 forward = glm::normalize(direction);
    glm::dvec3 right = glm::cross(forward, wantedUp);
    if (glm::length(right) <
        1e-6 * glm::length(wantedUp)) // looking straight along up: any other axis will do
        right = glm::cross(forward, std::abs(forward.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1));
    right = glm::normalize(right);
    return {right, glm::cross(right, forward), forward};
}

/// What the eight corners of the bounds need, seen from `target` along `axes`: distance (perspective) or
/// height.
struct Frame {
    double distance = 0; // m
    double height = 0;   // m
};

Frame frameBounds(const Axes& axes, const glm::dvec3& target, const glm::dvec3& lowest,
                  const glm::dvec3& highest, double tangent, double aspect) {
    Frame frame;
    for (int c = 0; c < 8; ++c) {
        const glm::dvec3 corner(c & 1 ? highest.x : lowest.x, c & 2 ? highest.y : lowest.y,
                                c & 4 ? highest.z : lowest.z);
        const glm::dvec3 q = corner - target;
        const double half =
            std::max(std::abs(glm::dot(q, axes.up)), std::abs(glm::dot(q, axes.right)) / aspect);
        frame.distance = std::max(frame.distance, kMargin * half / tangent - glm::dot(q, axes.forward));
        frame.height = std::max(frame.height, 2 * kMargin * half);
    }
    return frame;
}

} // namespace

CameraView makeCamera(const sim::Camera& settings, const glm::dvec3& lowest, const glm::dvec3& highest,
                      double aspect) {
    const glm::dvec3 centre = 0.5 * (lowest + highest);
    const double radius = std::max(0.5 * glm::length(highest - lowest), 1e-9);
    const glm::dvec3 target = settings.target.value_or(centre);
    const double tangent = std::tan(0.5 * settings.fieldOfView);

    glm::dvec3 direction = settings.eye ? target - *settings.eye : settings.direction;
    if (glm::length(direction) < 1e-12 * radius)
        direction = {0, 0, -1}; // the eye is its own target: look along -z
    const Axes axes = axesOf(direction, settings.up);
    const Frame frame = frameBounds(axes, target, lowest, highest, tangent, aspect);

    CameraView view;
    const double framed =
        settings.projection == sim::Projection::orthographic ? 3 * radius : frame.distance / settings.zoom;
    view.eye = settings.eye.value_or(target - std::max(framed, 1e-9) * axes.forward);
    view.cameraFromWorld = glm::lookAt(view.eye, view.eye + axes.forward, axes.up);

    // The bounds grow when tissue is pulled: three radii on either side of the centre are in depth range.
    const double depth = glm::dot(centre - view.eye, axes.forward);
    const double farthest = std::max(depth + 3 * radius, 0.1 * radius);
    if (settings.projection == sim::Projection::orthographic) {
        const double height = settings.height.value_or(frame.height / settings.zoom);
        const double halfWidth = 0.5 * height * aspect;
        view.clipFromCamera =
            glm::ortho(-halfWidth, halfWidth, -0.5 * height, 0.5 * height, depth - 3 * radius, farthest);
    } else {
        const double nearest = std::max({depth - 3 * radius, 0.02 * radius, 0.01 * depth});
        view.clipFromCamera = glm::perspective(settings.fieldOfView, aspect, nearest, farthest);
    }
    return view;
}

CameraView carriedAround(const CameraView& camera, const glm::dvec3& middle, double angle) {
    glm::dmat4 turn = glm::translate(glm::dmat4(1), middle); // of the world, the other way
    turn = glm::rotate(turn, -angle, glm::dvec3(0, 1, 0));
    turn = glm::translate(turn, -middle);
    CameraView carried = camera;
    carried.cameraFromWorld = camera.cameraFromWorld * turn;
    carried.eye = glm::dvec3(glm::inverse(turn) * glm::dvec4(camera.eye, 1));
    return carried;
}

} // namespace serosa::render
