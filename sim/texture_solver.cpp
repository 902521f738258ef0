// See sim/texture_solver.h.
#include "sim/texture_solver.h"

#include "shaders/shared_constants.h"
#include "sim/solver_program.h"

namespace serosa::sim {

void TextureSolver::setState(const LatticeState& state) {
    textures_.upload(state);
    step_ = state.step;
}

StateTextures* TextureSolver::replaceState(std::int64_t step) {
    step_ = step;
    cuts_.forget();
    return &textures_;
}

void TextureSolver::setConstants() {
    stepProgram_.each([this](gpu::Program& program) { setKernelUniforms(program, setup_); });
    if (textures_.layout().kind == SRS_LAYOUT_ROWS) {
        stepProgram_.image("i_rowOffsetsA", textures_.rowOffsets_[0], GL_READ_ONLY);
        stepProgram_.image("i_rowOffsetsB", textures_.rowOffsets_[1], GL_READ_ONLY);
    }
}

void TextureSolver::setStepInputs(gpu::Program& program, bool useTexelFetch) {
    if (useTexelFetch) {
        program.texture("t_positions", textures_.positions());
        program.texture("t_increments", textures_.increments());
    } else {
        program.image("i_positions", textures_.positions(), GL_READ_ONLY);
        program.image("i_increments", textures_.increments(), GL_READ_ONLY);
    }
    program.image("i_nodeInfo", textures_.nodeInfo(), GL_READ_ONLY);
}

void TextureSolver::setTools(gpu::Program& program) {
    if (setup_.tools.empty())
        return;
    const std::vector<ToolMotion> tools = toolMotions(setup_, step_);
    setToolUniforms(program, tools);
    for (std::size_t i = 0; i < tools.size(); ++i) {
        if (!tools[i].closes && !tools[i].opens)
            continue;
        graspProgram_.image("i_nodeInfo", textures_.nodeInfo(), GL_READ_ONLY);
        graspProgram_.image("i_positions", textures_.positions(), GL_READ_ONLY);
        setGraspUniforms(graspProgram_, unsigned(i + 1), tools[i]);
        const int to = 1 - textures_.currentInfo_;
        runGrasp(to);
        textures_.currentInfo_ = to;
    }
}

void TextureSolver::finishStep() {
    textures_.current_ = nextHalf();
    ++step_;
}

} // namespace serosa::sim
