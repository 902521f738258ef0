// See sim/step_program.h.
#include "sim/step_program.h"

#include <algorithm>

namespace serosa::sim {

Result<StepProgram> StepProgram::create(const gpu::ShaderLibrary& library,
                                        const std::vector<std::string>& stages,
                                        const std::vector<gpu::ShaderDefine>& defines,
                                        const KernelOptions& options) {
    StepProgram step;
    SEROSA_ASSIGN(gpu::Program last, gpu::Program::create(library, stages, defines));
    step.programs_.push_back(std::move(last));
    if (!options.normals || options.normalsEveryStep)
        return step;
    std::vector<gpu::ShaderDefine> without = defines;
    std::erase_if(without, [](const gpu::ShaderDefine& define) { return define.name == "SRS_NORMALS"; });
    SEROSA_ASSIGN(gpu::Program other, gpu::Program::create(library, stages, without));
    step.programs_.push_back(std::move(other));
    return step;
}

} // namespace serosa::sim
