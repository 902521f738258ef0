// MS05 3.1: the lattice is stepped in a fragment shader (shaders/solver_step.frag) over 2D state textures,
// several steps a frame, ping-pong, with no readback. Tool impulses are summed by blending into one small
// texture a tool.
#include "shaders/shared_constants.h"
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
        for (std::size_t tool = 0; tool < setup_.tools.size(); ++tool) {
            glEnablei(GL_BLEND, GLuint(2 + tool));
            glBlendFunci(GLuint(2 + tool), GL_ONE, GL_ONE);
        }
        for (int i = 0; i < count; ++i)
            takeStep(i + 1 == count);
        for (std::size_t tool = 0; tool < setup_.tools.size(); ++tool)
            glDisablei(GL_BLEND, GLuint(2 + tool));
    }

    std::vector<ToolLoad> takeLoads() override {
        const double unit = impulseUnit(setup_);
        std::vector<ToolLoad> loads;
        std::vector<glm::vec4> texels(textures_.layout().texels());
        for (gpu::Texture2D& texture : impulses_) {
            texture.download(texels.data(), texels.size() * sizeof texels[0]);
            glm::dvec3 sum(0);
            for (const glm::vec4& texel : texels)
                sum += glm::dvec3(texel);
            loads.push_back({sum * unit, glm::dvec3(0)});
            texture.clear(glm::vec4(0));
        }
        return loads;
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
        SEROSA_ASSIGN(graspProgram_, gpu::Program::create(library, {"pass.vert", "grasp.frag"}));

        for (std::size_t tool = 0; tool < setup_.tools.size(); ++tool) {
            impulses_.emplace_back("tool impulse", GL_RGBA32F, layout.width, layout.height);
            impulses_.back().clear(glm::vec4(0));
        }
        for (std::size_t i = 0; i < 2; ++i) {
            stepTargets_[i] = gpu::Framebuffer("step target");
            stepTargets_[i].attach(GL_COLOR_ATTACHMENT0, textures_.positions_[i]);
            stepTargets_[i].attach(GL_COLOR_ATTACHMENT1, textures_.increments_[i]);
            for (std::size_t tool = 0; tool < impulses_.size(); ++tool)
                stepTargets_[i].attach(GLenum(GL_COLOR_ATTACHMENT2 + tool), impulses_[tool]);
            stepTargets_[i].setDrawBuffers(int(2 + impulses_.size()));
            graspTargets_[i] = gpu::Framebuffer("grasp target");
            graspTargets_[i].attach(GL_COLOR_ATTACHMENT0, textures_.nodeInfo_[i]);
            graspTargets_[i].setDrawBuffers(1);
        }
        if (setup_.tissue.needsCellPass())
            SEROSA_TRY(cellPass_.initialize(setup_, textures_, defines, stepProgram_, false));
        emptyVertices_ = gpu::VertexArray("no attributes");

        setConstants();
        return {};
    }

    void takeStep(bool last) {
        gpu::Program& program = stepProgram_.of(last);
        setTools(program);
        if (setup_.tissue.needsCellPass()) {
            // The first tool's impulse blends into attachment 2, this pass's third column must not.
            glDisablei(GL_BLEND, 2);
            cellPass_.run(textures_);
            if (!setup_.tools.empty())
                glEnablei(GL_BLEND, 2);
        }
        setStepInputs(program, options_.useTexelFetch);
        stepTargets_[std::size_t(nextHalf())].bind(textures_.layout().width, textures_.layout().height);
        program.use();
        // Image loads are incoherent: what the last pass wrote as a render target must be visible first.
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                        GL_TEXTURE_FETCH_BARRIER_BIT);
        gpu::drawFullScreen(emptyVertices_);
        finishStep();
    }

    void runGrasp(int to) override {
        graspTargets_[std::size_t(to)].bind(textures_.layout().width, textures_.layout().height);
        graspProgram_.use();
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
        gpu::drawFullScreen(emptyVertices_);
    }

    FragmentOptions options_;
    gpu::Framebuffer stepTargets_[2], graspTargets_[2];
    std::vector<gpu::Texture2D> impulses_; // one a tool
    gpu::VertexArray emptyVertices_;
};

Result<std::unique_ptr<Solver>> makeFragmentSolver(const SolverSetup& setup, const FragmentOptions& options) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    SEROSA_CHECK(setup.tools.size() <= SRS_MAX_TOOLS, "at most SRS_MAX_TOOLS tools");
    return FragmentSolver::create(setup, options);
}

} // namespace serosa::sim
