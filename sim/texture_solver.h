#pragma once
// What the fragment and the compute solver share: state textures, the step's and the grasp's programs with
// what they read, tools, and cuts. The two differ in what runs the kernel and in where it writes.

#include "gpu/program.h"
#include "sim/cell_pass.h"
#include "sim/cut_pass.h"
#include "sim/solver.h"
#include "sim/state_textures.h"
#include "sim/step_program.h"
#include "sim/tool_motion.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

class TextureSolver : public Solver {
public:
    const SolverSetup& setup() const override { return setup_; }
    const StateTextures* textures() const override { return &textures_; }
    LatticeState state() const override { return textures_.download(step_); }
    void setState(const LatticeState& state) override;
    StateTextures* replaceState(std::int64_t step) override;
    Status cut(const Stroke& stroke) override { return cuts_.cut(textures_, lattice(), stroke); }
    bool undoCut() override { return cuts_.undo(textures_); }
    void forgetCuts() override { cuts_.forget(); }
    std::vector<CutLayer> cutLayers() const override { return cuts_.layers(textures_); }
    Status setCutLayers(const std::vector<CutLayer>& layers) override {
        return cuts_.setLayers(textures_, layers);
    }
    Result<std::vector<std::uint32_t>> pieces() const override { return cuts_.pieces(textures_); }

protected:
    explicit TextureSolver(const SolverSetup& setup) : setup_(setup) {}

    /// What stepProgram_ reads and does not change between steps; the program must be made.
    void setConstants();
    /// What the program of the step to come reads. \param useTexelFetch as KernelOptions
    void setStepInputs(gpu::Program& program, bool useTexelFetch);
    /// Tools of the step to come: uniforms of its program, and a grasp pass for each that takes hold or lets
    /// go.
    void setTools(gpu::Program& program);
    /// The half of the state that the step writes.
    int nextHalf() const { return 1 - textures_.current_; }
    /// The step is written.
    void finishStep();

    SolverSetup setup_;
    StateTextures textures_;
    StepProgram stepProgram_;
    gpu::Program graspProgram_;
    CellPass cellPass_; // initialized where the tissue needs it

private:
    /// Runs graspProgram_, whose inputs are set, over all texels into node info `to`.
    virtual void runGrasp(int to) = 0;

    mutable CutPass cuts_; // programs made when first needed
    std::int64_t step_ = 0;
};

} // namespace serosa::sim
