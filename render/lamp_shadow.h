#pragma once
// The depth map of the key lamp: what it sees of organs and tools, for shadows (shaders/lamp_shadow.glsl).
// Williams 1978, Casting Curved Shadows on Curved Surfaces.

#include "gpu/handles.h"
#include "render/camera.h"

namespace serosa::render {

class LampShadow {
public:
    /// Needs a current context. \param side texels
    explicit LampShadow(int side);

    /// Binds the map, cleared, for drawing depth alone.
    void begin() const;
    /// Depth test and back-face culling as PictureTarget::begin left them.
    void end() const;
    const gpu::Texture2D& depth() const { return depth_; }
    int side() const { return depth_.width(); }

private:
    gpu::Texture2D depth_;
    gpu::Framebuffer target_;
};

/// The lamp as a camera: orthographic, along its light, around bounds (m, world) with half their size to
/// spare: organs move out of them.
CameraView lampView(const glm::dvec3& direction, const glm::dvec3& lowest, const glm::dvec3& highest);
/// What of the world the map covers, m.
double lampExtent(const glm::dvec3& lowest, const glm::dvec3& highest);

} // namespace serosa::render
