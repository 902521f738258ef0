#pragma once
// Node frames on the GPU (shaders/node_frames.comp): a texture beside the positions, 8 bytes a texel, written
// each frame from where the nodes are.

#include "base/result.h"
#include "gpu/program.h"
#include "render/node_frames.h"
#include "sim/texture_layout.h"

namespace serosa::render {

class FramePass {
public:
    /// Needs a current context. Errors: of the shader.
    static Result<FramePass> create(const FrameStencil& stencil, const sim::TextureLayout& layout);
    /// After cuts: frames from what connections are left.
    void update(const FrameStencil& stencil, const sim::TextureLayout& layout);
    /// Writes frames() from node positions in the same layout (RGBA32F).
    void run(const gpu::Texture2D& positions);
    /// RG32UI, packed (render/node_frames.h), at the nodes' texels; only nodes of the boundary have one.
    const gpu::Texture2D& frames() const { return frames_; }

private:
    FramePass() = default;
    gpu::Program program_;
    gpu::Buffer rows_;
    gpu::Texture2D terms_, frames_;
    int count_ = 0;
};

} // namespace serosa::render
