// MS05 3.1: the lattice is stepped in a fragment shader (shaders/solver_step.frag) over 2D state textures,
// several steps a frame, ping-pong, with no readback.
#include "shaders/shared_constants.h"
#include "sim/implicit_solver.h"
#include "sim/solver_program.h"
#include "sim/texture_solver.h"

namespace serosa::sim {

class FragmentSolver final : public TextureSolver {
public:
    static Result<std::unique_ptr<Solver>> create(const SolverSetup& setup, const FragmentOptions& options) {
        std::unique_ptr<FragmentSolver> solver(new FragmentSolver(setup, options));
        SEROSA_TRY(solver->initialize());
        return std::unique_ptr<Solver>(std::move(solver));
    }

    const char* name() const override { return "fragment"; }

    void advance(int count) override {
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        takeSteps(count);
        // Contact writes images; drawing fetches the textures, readback and upload copy them.
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                        GL_FRAMEBUFFER_BARRIER_BIT);
    }

private:
    FragmentSolver(const SolverSetup& setup, const FragmentOptions& options)
        : TextureSolver(setup), options_(options) {}

    Status initialize() {
        SEROSA_ASSIGN(textures_, StateTextures::create(*setup_.lattice, setup_.fixed, options_.layout));
        const TextureLayout& layout = textures_.layout();
        const gpu::ShaderLibrary library;
        const std::vector<gpu::ShaderDefine> defines = kernelDefines(setup_, layout, options_);
        SEROSA_ASSIGN(stepProgram_,
                      StepProgram::create(library, {"pass.vert", "solver_step.frag"}, defines, options_));
        for (std::size_t i = 0; i < 2; ++i) {
            stepTargets_[i] = gpu::Framebuffer("step target");
            stepTargets_[i].attach(GL_COLOR_ATTACHMENT0, textures_.positions_[i]);
            stepTargets_[i].attach(GL_COLOR_ATTACHMENT1, textures_.increments_[i]);
            stepTargets_[i].setDrawBuffers(2);
        }
        if (setup_.tissue.needsCellPass())
            SEROSA_TRY(cellPass_.initialize(setup_, textures_, defines, stepProgram_, false));
        emptyVertices_ = gpu::VertexArray("no attributes");
        return initializeSteps();
    }

    void takeStep(bool last) override {
        gpu::Program& program = stepProgram_.of(last);
        if (setup_.tissue.needsCellPass())
            cellPass_.run(textures_);
        setStepInputs(program, options_.useTexelFetch);
        stepTargets_[std::size_t(nextHalf())].bind(textures_.layout().width, textures_.layout().height);
        program.use();
        // Image loads are incoherent: what the last pass wrote, as a render target or an image, must be
        // visible first.
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                        GL_TEXTURE_FETCH_BARRIER_BIT);
        gpu::drawFullScreen(emptyVertices_);
    }

    FragmentOptions options_;
    gpu::Framebuffer stepTargets_[2];
    gpu::VertexArray emptyVertices_;
};

Result<std::unique_ptr<Solver>> makeFragmentSolver(const SolverSetup& setup, const FragmentOptions& options) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    SEROSA_CHECK(setup.tools.size() <= SRS_MAX_TOOLS, "at most SRS_MAX_TOOLS tools");
    if (setup.method == StepMethod::implicit)
        return makeImplicitTextureSolver(setup, "fragment", options.layout);
    return FragmentSolver::create(setup, options);
}

} // namespace serosa::sim
