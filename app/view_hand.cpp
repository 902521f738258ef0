// See app/view_hand.h.
#include "app/view_hand.h"

#include <utility>

namespace serosa::app {

namespace {

constexpr double kWheelShare = 0.01; // of the organs' size, a notch of the wheel

} // namespace

Result<std::optional<glm::dvec3>> ViewHand::pick(const Ray& ray, const ScenePlayer& player) {
    std::optional<double> nearest;
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        SEROSA_ASSIGN(const std::optional<double> hit,
                      tissue_.firstHit(i, *parts_.organs[i], player.connections(i), ray));
        if (hit && (!nearest || *hit < *nearest))
            nearest = hit;
    }
    if (!nearest)
        return std::optional<glm::dvec3>();
    return std::optional<glm::dvec3>(ray.from + *nearest * ray.along);
}

Result<std::string> ViewHand::follow(ViewControls& controls, const render::CameraView& camera,
                                     const glm::dvec2& window, const ScenePlayer& player) {
    if (!parts_.hands)
        return std::string(
            std::exchange(wanted_, controls.hand) != controls.hand && controls.hand
                ? parts_.implicit.deformation()
                      ? "no hands here: deformations alone move this scene (ctrl + shift + drag); "
                        "gravity or a tool would let its organs move"
                      : "no hands here: the scene has as many tools as there can be"
                : "");
    const Ray ray = rayThrough(camera, controls.pointer, window);
    const double now = player.time();
    std::string said;
    if (wanted_ != controls.hand) {
        wanted_ = controls.hand;
        parts_.hands->end(now);
        force_ = depth_ = 0;
        std::optional<glm::dvec3> touched;
        if (wanted_) {
            SEROSA_ASSIGN(touched, pick(ray, player));
        }
        if (touched) {
            start_ = *touched;
            toEye_ = glm::dvec3(camera.cameraFromWorld[0][2], camera.cameraFromWorld[1][2],
                                camera.cameraFromWorld[2][2]); // the camera's own z axis
            parts_.hands->begin(*wanted_, now, start_, -ray.along);
            said = *wanted_ == HandKind::grasp ? "the hand takes hold" : "the finger pushes";
        } else if (wanted_) {
            said = "no tissue under the pointer";
        }
    }
    depth_ +=
        kWheelShare * glm::distance(parts_.lowest(), parts_.highest()) * std::exchange(controls.deeper, 0);
    if (active())
        parts_.hands->moveTo(onPlane(ray, start_ - depth_ * toEye_, toEye_));
    return said;
}

void ViewHand::beforeFrame(double end) {
    if (parts_.hands)
        parts_.hands->sample(end);
}

void ViewHand::afterFrame(ScenePlayer& player) {
    if (!parts_.hands)
        return;
    glm::dvec3 impulse(0); // of the last frame that is known, of all organs
    for (std::size_t i = 0; i < parts_.organs.size(); ++i) {
        const std::vector<FrameLoads> given = player.takeLoads(i);
        if (given.empty() || !active())
            continue;
        const std::size_t first = parts_.scene.tools.size() - parts_.hands->tools().size();
        impulse += given.back().loads[first + std::size_t(*parts_.hands->active())].impulse;
    }
    force_ = glm::length(impulse) * parts_.scene.frameRate;
}

void ViewHand::restart() {
    if (parts_.hands)
        parts_.hands->clear();
    force_ = 0;
}

} // namespace serosa::app
