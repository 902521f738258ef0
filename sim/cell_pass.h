#pragma once
// The pass over an organ's cells before each step, where Tissue::needsCellPass() (shaders/cell_terms.glsl):
// the volumetric term and stiffening, for every solver whose state lies in StateTextures.

#include "base/result.h"
#include "gpu/program.h"
#include "sim/solver.h"
#include "sim/state_textures.h"
#include "sim/step_program.h"

#include <vector>

namespace serosa::sim {

/// Of one StateTextures. Needs a current context.
class CellPass {
public:
    /// Makes program and textures, and lets `step` read what the pass writes.
    /// \param defines kernelDefines of the step \param compute a compute pass; else a fragment pass
    /// Errors: of the shaders.
    Status initialize(const SolverSetup& setup, const StateTextures& textures,
                      const std::vector<gpu::ShaderDefine>& defines, StepProgram& step, bool compute);
    /// From the current positions and node info. The barriers that its reads and writes need are its own.
    void run(const StateTextures& textures);
    /// Texture memory; 0 before initialize().
    std::size_t bytes() const;

private:
    gpu::Program program_;
    gpu::Texture2D columns_[3]; // a cell's fill dW/dF, column by column; alphas: J, factor, nothing
    gpu::Framebuffer target_;   // fragment pass
    gpu::VertexArray emptyVertices_;
    bool compute_ = false;
};

} // namespace serosa::sim
