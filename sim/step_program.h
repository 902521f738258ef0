#pragma once
// The program of a solver step, twice: with normals, and without. Normals (MS05 eq. 3) are for drawing only,
// so that only the last step of an advance() needs them. What stays from step to step is set in
// both, what changes in the one that runs.

#include "gpu/program.h"
#include "sim/solver.h"

#include <string>
#include <vector>

namespace serosa::sim {

class StepProgram {
public:
    /// \param defines kernelDefines of `options` and what the stages need beside them.
    /// Errors: of the shaders.
    static Result<StepProgram> create(const gpu::ShaderLibrary& library,
                                      const std::vector<std::string>& stages,
                                      const std::vector<gpu::ShaderDefine>& defines,
                                      const KernelOptions& options);

    /// The program of a step. \param last it is the last one of its advance()
    gpu::Program& of(bool last) { return last ? programs_.front() : programs_.back(); }

    /// Calls `change` with each program.
    template <class Change>
    void each(const Change& change) {
        for (gpu::Program& program : programs_)
            change(program);
    }
    // As gpu::Program.
    template <class Value>
    void set(const std::string& name, const Value& value) {
        each([&](gpu::Program& program) { program.set(name, value); });
    }
    void texture(const std::string& name, const gpu::Texture2D& texture) {
        each([&](gpu::Program& program) { program.texture(name, texture); });
    }
    void image(const std::string& name, const gpu::Texture2D& texture, GLenum access) {
        each([&](gpu::Program& program) { program.image(name, texture, access); });
    }
    void buffer(const std::string& name, const gpu::Buffer& buffer) {
        each([&](gpu::Program& program) { program.buffer(name, buffer); });
    }

private:
    std::vector<gpu::Program> programs_; // with normals first; one alone where all steps are alike
};

} // namespace serosa::sim
