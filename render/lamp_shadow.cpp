// See render/lamp_shadow.h.
#include "render/lamp_shadow.h"

#include "gpu/gl.h"

#include <glm/gtc/matrix_transform.hpp>

namespace serosa::render {

namespace {

constexpr double kRoom = 1.5; // of the diagonal of the bounds

} // namespace

LampShadow::LampShadow(int side)
    : depth_("lamp's depth", GL_DEPTH_COMPONENT32F, side, side), target_("lamp") {
    target_.attach(GL_DEPTH_ATTACHMENT, depth_);
    target_.setDrawBuffers(0);
}

void LampShadow::begin() const {
    target_.bind(side(), side());
    const float farthest = 1;
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(target_.id(), GL_DEPTH, 0, &farthest);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDisable(GL_CULL_FACE); // a cut organ is open
}

void LampShadow::end() const {
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
}

double lampExtent(const glm::dvec3& lowest, const glm::dvec3& highest) {
    return kRoom * glm::distance(lowest, highest);
}

CameraView lampView(const glm::dvec3& direction, const glm::dvec3& lowest, const glm::dvec3& highest) {
    const glm::dvec3 middle = 0.5 * (lowest + highest), along = glm::normalize(direction);
    const glm::dvec3 up = std::abs(along.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const double reach = 0.5 * lampExtent(lowest, highest);
    CameraView view;
    view.eye = middle - 2 * reach * along;
    view.cameraFromWorld = glm::lookAt(view.eye, middle, up);
    view.clipFromCamera = glm::ortho(-reach, reach, -reach, reach, reach, 3 * reach);
    return view;
}

} // namespace serosa::render
