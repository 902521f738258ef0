// The fragment and the compute solver where they take implicit steps: both by the compute passes of
// sim/implicit_passes.h, over the same textures as their explicit steps.
#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/implicit_passes.h"
#include "sim/implicit_solver.h"
#include "sim/texture_solver.h"

namespace serosa::sim {

namespace {

class ImplicitTextureSolver final : public TextureSolver, public HasImplicitEffort {
public:
    ImplicitTextureSolver(const SolverSetup& setup, const char* name) : TextureSolver(setup), name_(name) {}

    Status initialize(int layout, const ImplicitLimits& limits) {
        SEROSA_ASSIGN(textures_, StateTextures::create(*setup_.lattice, setup_.fixed, layout));
        SEROSA_TRY(initializeContact());
        return passes_.initialize(setup_, textures_, limits, contact_, loads_.sums());
    }

    const char* name() const override { return name_; }

    void advance(int count) override {
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        for (int i = 0; i < count; ++i) {
            contact_.prepare(textures_, step_, 1);
            passes_.asks().prepare(textures_, step_, 1);
            passes_.step(textures_, step_++);
        }
        // Drawing fetches the textures; readback and upload copy them; cuts draw over the node info.
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                        GL_FRAMEBUFFER_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }

    ImplicitEffort effort() const override { return passes_.effort(); }

    // What asks learns what happened to the state, as contact_ does.
    void setState(const LatticeState& state) override {
        TextureSolver::setState(state);
        passes_.asks().connect(textures_,
                               state.connections.empty() ? lattice().connections : state.connections);
        passes_.asks().restart();
    }
    StateTextures* replaceState(std::int64_t step) override {
        passes_.asks().restart();
        return TextureSolver::replaceState(step);
    }
    Status cut(const Stroke& stroke) override {
        passes_.asks().connectionsChanged();
        return TextureSolver::cut(stroke);
    }
    bool undoCut() override {
        passes_.asks().connectionsChanged();
        return TextureSolver::undoCut();
    }

private:
    void takeStep(bool /*last*/) override { SEROSA_CHECK(false, "explicit steps are not this solver's"); }

    const char* name_;
    ImplicitPasses passes_;
};

} // namespace

Result<std::unique_ptr<Solver>> makeImplicitTextureSolver(const SolverSetup& setup, const char* name,
                                                          int layout, const ImplicitLimits& limits) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    auto solver = std::make_unique<ImplicitTextureSolver>(setup, name);
    SEROSA_TRY(solver->initialize(layout, limits));
    return std::unique_ptr<Solver>(std::move(solver));
}

} // namespace serosa::sim
