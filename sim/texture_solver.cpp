// See sim/texture_solver.h.
#include "sim/texture_solver.h"

#include "shaders/shared_constants.h"
#include "sim/solver_program.h"

#include <algorithm>

namespace serosa::sim {

void TextureSolver::setState(const LatticeState& state) {
    textures_.upload(state);
    contact_.connect(textures_, state.connections.empty() ? lattice().connections : state.connections);
    contact_.restart();
    step_ = state.step;
}

StateTextures* TextureSolver::replaceState(std::int64_t step) {
    step_ = step;
    cuts_.forget();
    contact_.restart();
    return &textures_;
}

Status TextureSolver::cut(const Stroke& stroke) {
    contact_.connectionsChanged();
    return cuts_.cut(textures_, lattice(), stroke);
}

bool TextureSolver::undoCut() {
    contact_.connectionsChanged();
    return cuts_.undo(textures_);
}

Status TextureSolver::initializeSteps() {
    stepProgram_.each([this](gpu::Program& program) { setKernelUniforms(program, setup_); });
    if (textures_.layout().kind == SRS_LAYOUT_ROWS) {
        stepProgram_.image("i_rowOffsetsA", textures_.rowOffsets_[0], GL_READ_ONLY);
        stepProgram_.image("i_rowOffsetsB", textures_.rowOffsets_[1], GL_READ_ONLY);
    }
    return initializeContact();
}

Status TextureSolver::initializeContact() {
    loads_ = ToolLoads(setup_);
    return contact_.initialize(setup_, textures_, loads_.sums());
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

void TextureSolver::takeSteps(int count) {
    constexpr int kPrepared = 64; // steps whose colliders are uploaded together
    for (int i = 0; i < count; ++i) {
        if (i % kPrepared == 0)
            contact_.prepare(textures_, step_, std::min(kPrepared, count - i));
        takeStep(i + 1 == count);
        textures_.current_ = nextHalf();
        contact_.run(textures_, step_);
        ++step_;
    }
}

} // namespace serosa::sim
