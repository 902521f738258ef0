// The lattice stepped by compute passes (shaders/solver_step.comp): the fragment solver's kernel, textures
// and order of passes, with image stores in place of render targets. Tool impulses go to one slot a texel and
// tool, which a second pass sums in a fixed order when they are asked for.
#include "shaders/shared_constants.h"
#include "sim/solver_program.h"
#include "sim/texture_solver.h"

#include <array>

namespace serosa::sim {

namespace {

constexpr int kImpulseRun = 4096; // texels whose impulses one work group sums

} // namespace

class ComputeSolver final : public TextureSolver {
public:
    static Result<std::unique_ptr<Solver>> create(const SolverSetup& setup, const ComputeOptions& options) {
        std::unique_ptr<ComputeSolver> solver(new ComputeSolver(setup, options));
        SEROSA_TRY(solver->initialize());
        return std::unique_ptr<Solver>(std::move(solver));
    }

    const char* name() const override { return "compute"; }

    void advance(int count) override {
        // What earlier draws wrote as render targets or uploads must be visible to the first step.
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        for (int i = 0; i < count; ++i)
            takeStep(i + 1 == count);
        // Drawing fetches the textures; readback and upload copy them.
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                        GL_FRAMEBUFFER_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }

    std::vector<ToolLoad> takeLoads() override {
        const std::size_t tools = setup_.tools.size();
        std::vector<ToolLoad> loads(tools);
        if (tools == 0)
            return loads;
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        impulseProgram_.dispatch({impulseGroups_ * impulseProgram_.groupSize().x, 1, 1});
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
        std::vector<float> sums(std::size_t(impulseGroups_) * tools * 3);
        impulseSums_.download(0, sums.size() * sizeof sums[0], sums.data());
        for (std::size_t i = 0; i < sums.size(); i += 3)
            loads[i / 3 % tools].impulse += glm::dvec3(sums[i], sums[i + 1], sums[i + 2]);
        for (ToolLoad& load : loads)
            load.impulse *= impulseUnit(setup_);
        return loads;
    }

private:
    ComputeSolver(const SolverSetup& setup, const ComputeOptions& options)
        : TextureSolver(setup), options_(options) {}

    Status initialize() {
        SEROSA_ASSIGN(textures_, StateTextures::create(*setup_.lattice, setup_.fixed, options_.layout));
        const TextureLayout& layout = textures_.layout();
        const bool grid = layout.kind == SRS_LAYOUT_GRID, tiles = options_.tiles && grid;
        const glm::ivec3 group = tiles  ? options_.tileGroup
                                 : grid ? glm::ivec3(options_.gridGroup, 1)
                                        : glm::ivec3(options_.rowsGroup, 1);
        // Without tiles the grid is one strip: the slices need no axis of their own.
        items_ = tiles ? setup_.lattice->nodeDims : glm::ivec3(layout.width, layout.height, 1);
        std::vector<gpu::ShaderDefine> defines = kernelDefines(setup_, layout, options_);
        defines.push_back({"SRS_GROUP_X", std::to_string(group.x)});
        defines.push_back({"SRS_GROUP_Y", std::to_string(group.y)});
        defines.push_back({"SRS_GROUP_Z", std::to_string(group.z)});
        if (tiles)
            defines.push_back({"SRS_TILES", "1"});
        const gpu::ShaderLibrary library;
        SEROSA_ASSIGN(stepProgram_, StepProgram::create(library, {"solver_step.comp"}, defines, options_));
        SEROSA_ASSIGN(graspProgram_, gpu::Program::create(library, {"grasp.comp"}));
        if (setup_.tissue.needsCellPass())
            SEROSA_TRY(cellPass_.initialize(setup_, textures_, kernelDefines(setup_, layout, options_),
                                            stepProgram_, true));
        setConstants();
        stepProgram_.set("u_items", items_);
        return createImpulses(library);
    }

    Status createImpulses(const gpu::ShaderLibrary& library) {
        const std::size_t tools = setup_.tools.size();
        if (tools == 0)
            return {};
        const std::size_t texels = textures_.layout().texels();
        SEROSA_ASSIGN(impulseProgram_, gpu::Program::create(library, {"tool_impulses.comp"},
                                                            {{"SRS_TOOLS", std::to_string(tools)},
                                                             {"SRS_RUN", std::to_string(kImpulseRun)}}));
        impulseGroups_ = int((texels + kImpulseRun - 1) / kImpulseRun);
        const std::vector<float> zero(texels * tools * 3, 0.0f);
        impulses_ = gpu::Buffer("tool impulses", std::span<const float>(zero));
        impulseSums_ = gpu::Buffer("tool impulse sums",
                                   std::size_t(impulseGroups_) * tools * 3 * sizeof(float), nullptr);
        impulseProgram_.set("u_texels", int(texels));
        impulseProgram_.buffer("b_impulses", impulses_).buffer("b_sums", impulseSums_);
        stepProgram_.buffer("b_impulses", impulses_);
        return {};
    }

    void takeStep(bool last) {
        gpu::Program& program = stepProgram_.of(last);
        setTools(program);
        if (setup_.tissue.needsCellPass())
            cellPass_.run(textures_);
        setStepInputs(program, options_.useTexelFetch);
        const std::size_t to = std::size_t(nextHalf());
        program.image("i_newPositions", textures_.positions_[to], GL_WRITE_ONLY);
        program.image("i_newIncrements", textures_.increments_[to], GL_WRITE_ONLY);
        program.dispatch(items_);
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                        GL_SHADER_STORAGE_BARRIER_BIT);
        finishStep();
    }

    void runGrasp(int to) override {
        graspProgram_.image("i_newNodeInfo", textures_.nodeInfo_[to], GL_WRITE_ONLY);
        graspProgram_.dispatch({textures_.layout().width, textures_.layout().height, 1});
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    }

    ComputeOptions options_;
    gpu::Program impulseProgram_;
    gpu::Buffer impulses_, impulseSums_; // a slot (3 floats) a texel and tool; a sum a group and tool
    int impulseGroups_ = 0;
    glm::ivec3 items_{0};
};

Result<std::unique_ptr<Solver>> makeComputeSolver(const SolverSetup& setup, const ComputeOptions& options) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    SEROSA_CHECK(setup.tools.size() <= SRS_MAX_TOOLS, "at most SRS_MAX_TOOLS tools");
    return ComputeSolver::create(setup, options);
}

} // namespace serosa::sim
