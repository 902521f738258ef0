// The fragment and the compute solver where they take implicit steps: both by the compute passes of
// sim/implicit_passes.h, over the same textures as their explicit steps.
#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/implicit_passes.h"
#include "sim/implicit_solver.h"
#include "sim/solver_program.h"
#include "sim/texture_solver.h"

namespace serosa::sim {

namespace {

class ImplicitTextureSolver final : public TextureSolver, public HasImplicitEffort {
public:
    ImplicitTextureSolver(const SolverSetup& setup, const char* name) : TextureSolver(setup), name_(name) {}

    Status initialize(int layout, const ImplicitLimits& limits) {
        SEROSA_ASSIGN(textures_, StateTextures::create(*setup_.lattice, setup_.fixed, layout));
        SEROSA_TRY(passes_.initialize(setup_, textures_, limits));
        const gpu::ShaderLibrary library;
        SEROSA_ASSIGN(graspProgram_, gpu::Program::create(library, {"grasp.comp"}));
        return {};
    }

    const char* name() const override { return name_; }

    void advance(int count) override {
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        for (int i = 0; i < count; ++i) {
            const std::vector<ToolMotion> tools = stepTools();
            takeHold(tools);
            passes_.step(textures_, tools);
            finishStepInPlace();
        }
        // Drawing fetches the textures; readback and upload copy them; cuts draw over the node info.
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                        GL_FRAMEBUFFER_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }

    std::vector<ToolLoad> takeLoads() override {
        std::vector<ToolLoad> loads;
        for (const glm::dvec3& impulse : passes_.takeImpulses())
            loads.push_back({impulse * impulseUnit(setup_), glm::dvec3(0)});
        return loads;
    }

    ImplicitEffort effort() const override { return passes_.effort(); }

private:
    void runGrasp(int to) override {
        passes_.storeGrasp(textures_, graspProgram_, to);
        graspProgram_.dispatch({textures_.layout().width, textures_.layout().height, 1});
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    }

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
