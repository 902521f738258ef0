// The lattice stepped by compute passes (shaders/solver_step.comp): the fragment solver's kernel, textures
// and order of passes, with image stores in place of render targets.
#include "shaders/shared_constants.h"
#include "sim/implicit_solver.h"
#include "sim/solver_program.h"
#include "sim/texture_solver.h"

namespace serosa::sim {

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
        takeSteps(count);
        // Drawing fetches the textures; readback and upload copy them.
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                        GL_FRAMEBUFFER_BARRIER_BIT);
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
        if (setup_.tissue.needsCellPass())
            SEROSA_TRY(cellPass_.initialize(setup_, textures_, kernelDefines(setup_, layout, options_),
                                            stepProgram_, true));
        stepProgram_.set("u_items", items_);
        return initializeSteps();
    }

    void takeStep(bool last) override {
        gpu::Program& program = stepProgram_.of(last);
        if (setup_.tissue.needsCellPass())
            cellPass_.run(textures_);
        setStepInputs(program, options_.useTexelFetch);
        const std::size_t to = std::size_t(nextHalf());
        program.image("i_newPositions", textures_.positions_[to], GL_WRITE_ONLY);
        program.image("i_newIncrements", textures_.increments_[to], GL_WRITE_ONLY);
        program.dispatch(items_);
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    }

    ComputeOptions options_;
    glm::ivec3 items_{0};
};

Result<std::unique_ptr<Solver>> makeComputeSolver(const SolverSetup& setup, const ComputeOptions& options) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    SEROSA_CHECK(setup.tools.size() <= SRS_MAX_TOOLS, "at most SRS_MAX_TOOLS tools");
    if (setup.method == StepMethod::implicit)
        return makeImplicitTextureSolver(setup, "compute", options.layout);
    return ComputeSolver::create(setup, options);
}

} // namespace serosa::sim
