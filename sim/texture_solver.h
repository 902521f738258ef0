#pragma once
// What the fragment and the compute solver share: state textures, the step's program with what it reads,
// contact and grasps with their loads, and cuts. The two differ in what runs the kernel and in where it
// writes.

#include "gpu/program.h"
#include "sim/cell_pass.h"
#include "sim/contact_pass.h"
#include "sim/cut_pass.h"
#include "sim/solver.h"
#include "sim/state_textures.h"
#include "sim/step_program.h"
#include "sim/tool_loads.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

class TextureSolver : public Solver {
public:
    const SolverSetup& setup() const override { return setup_; }
    const StateTextures* textures() const override { return &textures_; }
    LatticeState state() const override { return textures_.download(step_); }
    void setState(const LatticeState& state) override;
    std::vector<ToolLoad> takeLoads() override { return loads_.take(); }
    void endFrame() override { loads_.endFrame(); }
    std::optional<std::vector<ToolLoad>> frameLoads() override { return loads_.frame(); }
    std::vector<std::vector<ToolLoad>> flushFrames() override { return loads_.flush(); }
    Status cut(const Stroke& stroke) override;
    bool undoCut() override;
    StateTextures* replaceState(std::int64_t step) override;
    void forgetCuts() override { cuts_.forget(); }
    std::vector<CutLayer> cutLayers() const override { return cuts_.layers(textures_); }
    Status setCutLayers(const std::vector<CutLayer>& layers) override {
        return cuts_.setLayers(textures_, layers);
    }
    Result<std::vector<std::uint32_t>> pieces() const override { return cuts_.pieces(textures_); }

protected:
    explicit TextureSolver(const SolverSetup& setup) : setup_(setup) {}

    /// What stepProgram_ reads and does not change between steps; the program must be made. Makes the contact
    /// passes. Errors: of their shaders.
    Status initializeSteps();
    /// What the program of the step to come reads. \param useTexelFetch as KernelOptions
    void setStepInputs(gpu::Program& program, bool useTexelFetch);
    /// Takes `count` steps: calls takeStep, and lets contact follow.
    void takeSteps(int count);
    /// The contact passes alone, for steps of another kind. Errors: of their shaders.
    Status initializeContact();
    /// The half of the state that the step writes.
    int nextHalf() const { return 1 - textures_.current_; }

    SolverSetup setup_;
    StateTextures textures_;
    StepProgram stepProgram_;
    CellPass cellPass_; // initialized where the tissue needs it
    ContactPass contact_;
    ToolLoads loads_;
    std::int64_t step_ = 0;

private:
    /// The force pass of one step, into nextHalf(). \param last the last one of its advance()
    virtual void takeStep(bool last) = 0;

    mutable CutPass cuts_; // programs made when first needed
};

} // namespace serosa::sim
