#pragma once
// Ambient occlusion found in the picture: how much of the surround each pixel sees, from the depths around
// it. After Mittring 2007 (Finding Next Gen, CryEngine 2) and McGuire et al. 2011 (The Alchemy Screen-Space
// Ambient Obscurance Algorithm), whose estimator shaders/screen_occlusion.frag takes.

#include "base/result.h"
#include "gpu/program.h"
#include "render/camera.h"

namespace serosa::render {

class ScreenOcclusion {
public:
    /// Needs a current context. Errors: of the shaders.
    static Result<ScreenOcclusion> create(int width, int height);

    /// Binds a depth target of the picture's size, cleared; organs and tools draw into it, then
    void begin() const;
    /// makes the occlusion of it, with what lies within `radius`, m.
    void make(const CameraView& camera, double radius);
    const gpu::Texture2D& light() const { return light_[1]; } // R8: of the surround, that reaches a pixel

private:
    ScreenOcclusion() = default;
    gpu::Texture2D depth_, light_[2];
    gpu::Framebuffer depthTarget_, lightTargets_[2];
    gpu::Program occlude_, blur_;
    gpu::VertexArray empty_;
};

} // namespace serosa::render
