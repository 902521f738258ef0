#pragma once
// Tools as steel spheres.

#include "base/result.h"
#include "gpu/program.h"
#include "render/frame.h"

namespace serosa::render {

class ToolSpheres {
public:
    static Result<ToolSpheres> create();
    /// Its program from another source. Errors: as gpu::Program::create.
    static Result<gpu::Program> compile(const gpu::ShaderLibrary& library);
    gpu::Program& program() { return program_; }
    /// Draws the frame's tools into the bound target with its depth test.
    void draw(const Frame& frame);

private:
    ToolSpheres() = default;
    gpu::Program program_;
    gpu::VertexArray array_;
    gpu::Buffer vertices_, indices_;
    int indexCount_ = 0;
};

} // namespace serosa::render
