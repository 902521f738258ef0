// See render/screen_occlusion.h.
#include "render/screen_occlusion.h"

#include "gpu/gl.h"

namespace serosa::render {

Result<ScreenOcclusion> ScreenOcclusion::create(int width, int height) {
    ScreenOcclusion made;
    const gpu::ShaderLibrary library;
    SEROSA_ASSIGN(made.occlude_, gpu::Program::create(library, {"pass.vert", "screen_occlusion.frag"}));
    SEROSA_ASSIGN(made.blur_, gpu::Program::create(library, {"pass.vert", "screen_occlusion_blur.frag"}));
    made.depth_ = gpu::Texture2D("picture's depth", GL_DEPTH_COMPONENT32F, width, height);
    made.depthTarget_ = gpu::Framebuffer("picture's depth");
    made.depthTarget_.attach(GL_DEPTH_ATTACHMENT, made.depth_);
    made.depthTarget_.setDrawBuffers(0);
    for (int i = 0; i < 2; ++i) {
        made.light_[i] = gpu::Texture2D("screen occlusion", GL_R8, width, height);
        made.lightTargets_[i] = gpu::Framebuffer("screen occlusion");
        made.lightTargets_[i].attach(GL_COLOR_ATTACHMENT0, made.light_[i]);
        made.lightTargets_[i].setDrawBuffers(1);
    }
    made.empty_ = gpu::VertexArray("no attributes");
    return made;
}

void ScreenOcclusion::begin() const {
    depthTarget_.bind(depth_.width(), depth_.height());
    const float farthest = 1;
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(depthTarget_.id(), GL_DEPTH, 0, &farthest);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDisable(GL_CULL_FACE);
}

void ScreenOcclusion::make(const CameraView& camera, double radius) {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    const int width = depth_.width(), height = depth_.height();
    lightTargets_[1].bind(width, height);
    occlude_.texture("t_depth", depth_);
    occlude_.set("u_cameraFromClip", glm::mat4(glm::inverse(camera.clipFromCamera)));
    occlude_.set("u_clipFromCamera", glm::mat4(camera.clipFromCamera)).set("u_radius", float(radius));
    occlude_.use();
    gpu::drawFullScreen(empty_);
    for (const int pass : {0, 1}) { // along x, then y
        lightTargets_[pass].bind(width, height);
        blur_.texture("t_light", light_[1 - pass]).texture("t_depth", depth_);
        blur_.set("u_step", pass == 0 ? glm::ivec2(1, 0) : glm::ivec2(0, 1));
        blur_.set("u_cameraFromClip", glm::mat4(glm::inverse(camera.clipFromCamera)));
        blur_.set("u_radius", float(radius));
        blur_.use();
        gpu::drawFullScreen(empty_);
    }
}

} // namespace serosa::render
