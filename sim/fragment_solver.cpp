// MS05 3.1: the lattice is stepped in a fragment shader (shaders/solver_step.frag) over 2D state textures,
// several steps a frame, ping-pong, with no readback. Tool impulses are summed by blending into one small
// texture a tool.
#include "gpu/program.h"
#include "shaders/shared_constants.h"
#include "sim/solver.h"
#include "sim/state_textures.h"
#include "sim/tool_motion.h"

#include <bit>

namespace serosa::sim {

class FragmentSolver final : public Solver {
public:
    static Result<std::unique_ptr<Solver>> create(const SolverSetup& setup, const FragmentOptions& options) {
        std::unique_ptr<FragmentSolver> solver(new FragmentSolver(setup, options));
        SEROSA_TRY(solver->initialize());
        return std::unique_ptr<Solver>(std::move(solver));
    }

    const char* name() const override { return "fragment"; }
    const StateTextures* textures() const override { return &textures_; }

    void advance(int count) override {
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        for (std::size_t tool = 0; tool < setup_.tools.size(); ++tool) {
            glEnablei(GL_BLEND, GLuint(2 + tool));
            glBlendFunci(GLuint(2 + tool), GL_ONE, GL_ONE);
        }
        for (int i = 0; i < count; ++i)
            takeStep();
        for (std::size_t tool = 0; tool < setup_.tools.size(); ++tool)
            glDisablei(GL_BLEND, GLuint(2 + tool));
    }

    LatticeState state() const override { return textures_.download(step_); }

    void setState(const LatticeState& state) override {
        textures_.upload(state);
        step_ = state.step;
    }

    std::vector<glm::dvec3> takeToolImpulses() override {
        // From mass shares times lattice units a step to N s.
        const double unit =
            setup_.tissue.nodeMass(setup_.lattice->spacing) * setup_.lattice->spacing / setup_.timeStep;
        std::vector<glm::dvec3> impulses;
        std::vector<glm::vec4> texels(textures_.layout().texels());
        for (gpu::Texture2D& texture : impulses_) {
            texture.download(texels.data(), texels.size() * sizeof texels[0]);
            glm::dvec3 sum(0);
            for (const glm::vec4& texel : texels)
                sum += glm::dvec3(texel);
            impulses.push_back(sum * unit);
            texture.clear(glm::vec4(0));
        }
        return impulses;
    }

private:
    FragmentSolver(const SolverSetup& setup, const FragmentOptions& options)
        : setup_(setup), options_(options) {}

    Status initialize() {
        SEROSA_ASSIGN(textures_, StateTextures::create(*setup_.lattice, setup_.fixed, options_.layout));
        const TextureLayout& layout = textures_.layout();
        std::vector<gpu::ShaderDefine> defines = {
            {"SRS_LAYOUT", std::to_string(layout.kind)},
            {"SRS_GRID_NY", std::to_string(layout.gridStride.z)},
            {"SRS_ROW_LOG2", std::to_string(std::countr_zero(unsigned(layout.width)))},
            {"SRS_TOOLS", std::to_string(setup_.tools.size())},
            {"SRS_EQUATION", options_.printedForm ? "2" : "1"}};
        if (setup_.tissue.dampingTime > 0)
            defines.push_back({"SRS_DAMPING", "1"});
        if (options_.normals)
            defines.push_back({"SRS_NORMALS", "1"});
        if (options_.useTexelFetch)
            defines.push_back({"SRS_TEXEL_FETCH", "1"});
        const gpu::ShaderLibrary library;
        SEROSA_ASSIGN(stepProgram_,
                      gpu::Program::create(library, {"pass.vert", "solver_step.frag"}, defines));
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
        emptyVertices_ = gpu::VertexArray("no attributes");

        const double h = setup_.lattice->spacing, dt = setup_.timeStep;
        stepProgram_.set("u_acceleration", float(dt * dt * setup_.tissue.stiffnessOverMass(h)));
        stepProgram_.set("u_drag", float(1 - setup_.tissue.airDrag * dt));
        stepProgram_.set("u_gravity", glm::vec3(setup_.gravity * (dt * dt / h)));
        stepProgram_.set("u_damping", float(setup_.tissue.dampingTime / dt));
        if (layout.kind == SRS_LAYOUT_ROWS) {
            stepProgram_.image("i_rowOffsetsA", textures_.rowOffsets_[0], GL_READ_ONLY);
            stepProgram_.image("i_rowOffsetsB", textures_.rowOffsets_[1], GL_READ_ONLY);
        }
        return {};
    }

    void takeStep() {
        if (!setup_.tools.empty())
            setTools();
        const int from = textures_.current_, to = 1 - from;
        if (options_.useTexelFetch) {
            stepProgram_.texture("t_positions", textures_.positions_[from]);
            stepProgram_.texture("t_increments", textures_.increments_[from]);
        } else {
            stepProgram_.image("i_positions", textures_.positions_[from], GL_READ_ONLY);
            stepProgram_.image("i_increments", textures_.increments_[from], GL_READ_ONLY);
        }
        stepProgram_.image("i_nodeInfo", textures_.nodeInfo(), GL_READ_ONLY);
        stepTargets_[std::size_t(to)].bind(textures_.layout().width, textures_.layout().height);
        stepProgram_.use();
        // Image loads are incoherent: what the last pass wrote as a render target must be visible first.
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                        GL_TEXTURE_FETCH_BARRIER_BIT);
        gpu::drawFullScreen(emptyVertices_);
        textures_.current_ = to;
        ++step_;
    }

    void setTools() {
        const std::vector<ToolMotion> tools = toolMotions(setup_, step_);
        std::array<glm::vec4, SRS_MAX_TOOLS> spheres{}, moves{};
        for (std::size_t i = 0; i < tools.size(); ++i) {
            spheres[i] = glm::vec4(glm::vec3(tools[i].to), float(tools[i].radius));
            moves[i] = glm::vec4(glm::vec3(tools[i].to - tools[i].from), float(tools[i].mode));
            if (tools[i].closes || tools[i].opens)
                updateHeld(unsigned(i + 1), tools[i]);
        }
        stepProgram_.set("u_toolSpheres", std::span<const glm::vec4>(spheres));
        stepProgram_.set("u_toolMoves", std::span<const glm::vec4>(moves));
    }

    void updateHeld(unsigned holder, const ToolMotion& tool) {
        const int to = 1 - textures_.currentInfo_;
        graspProgram_.image("i_nodeInfo", textures_.nodeInfo(), GL_READ_ONLY);
        graspProgram_.image("i_positions", textures_.positions(), GL_READ_ONLY);
        graspProgram_.set("u_sphere", glm::vec4(glm::vec3(tool.from), float(tool.radius)));
        graspProgram_.set("u_holder", holder);
        graspProgram_.set("u_closes", tool.closes ? 1 : 0);
        graspTargets_[std::size_t(to)].bind(textures_.layout().width, textures_.layout().height);
        graspProgram_.use();
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
        gpu::drawFullScreen(emptyVertices_);
        textures_.currentInfo_ = to;
    }

    SolverSetup setup_;
    FragmentOptions options_;
    StateTextures textures_;
    gpu::Program stepProgram_, graspProgram_;
    gpu::Framebuffer stepTargets_[2], graspTargets_[2];
    std::vector<gpu::Texture2D> impulses_; // one a tool
    gpu::VertexArray emptyVertices_;
    std::int64_t step_ = 0;
};

Result<std::unique_ptr<Solver>> makeFragmentSolver(const SolverSetup& setup, const FragmentOptions& options) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    SEROSA_CHECK(setup.tools.size() <= SRS_MAX_TOOLS, "at most SRS_MAX_TOOLS tools");
    return FragmentSolver::create(setup, options);
}

} // namespace serosa::sim
