#pragma once
// The picture being drawn: a multisampled sRGB target with depth, resolved into a texture that can be read.

#include "gpu/handles.h"
#include "render/image.h"

namespace serosa::render {

class PictureTarget {
public:
    /// 8 samples a pixel where the context has them, else its most. Needs a current context. Sizes in pixels.
    PictureTarget(int width, int height);

    int width() const { return width_; }
    int height() const { return height_; }
    int samples() const { return samples_; }

    /// Binds the target, clears depth, and sets what drawing passes rely on: depth test, back faces culled,
    /// sRGB encoding.
    void begin() const;
    /// Only binds it: passes that discard all fragments still need a complete framebuffer.
    void bind() const;
    /// Resolves the samples (in linear light) and leaves depth test, culling, blending and sRGB encoding off.
    void end() const;
    /// Copies the last resolved picture into framebuffer 0 (a window) of this size, pixels.
    void show(int width, int height) const;
    /// The last resolved picture, top row first. Waits for the GPU.
    Image read() const;

private:
    int width_, height_, samples_;
    gpu::Renderbuffer colour_, depth_;
    gpu::Texture2D resolved_;
    gpu::Framebuffer drawn_, readable_;
};

} // namespace serosa::render
