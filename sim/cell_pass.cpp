// See sim/cell_pass.h.
#include "sim/cell_pass.h"

#include "shaders/shared_constants.h"

#include <span>

namespace serosa::sim {

namespace {

void setMaterials(gpu::Program& program, const Tissue& tissue) {
    std::vector<float> bulks, recoveries, springs, youngs, bends, strains, gains;
    for (const MaterialShares& material : materialShares(tissue)) {
        bulks.push_back(float(material.bulk));
        recoveries.push_back(float(material.recovery));
        springs.insert(springs.end(), material.spring.begin(), material.spring.end());
        youngs.push_back(float(material.young));
        bends.push_back(float(material.bend));
        for (std::size_t i = 0; i < SRS_CURVE_BREAKS; ++i) {
            const CurveBreak turn = i < material.breaks.size() ? material.breaks[i] : CurveBreak{};
            strains.push_back(float(turn.strain));
            gains.push_back(float(turn.gain));
        }
    }
    program.set("u_bulks", std::span<const float>(bulks));
    program.set("u_recoveries", std::span<const float>(recoveries));
    if (!tissue.stiffens())
        return;
    program.set("u_springs", std::span<const float>(springs));
    program.set("u_youngs", std::span<const float>(youngs));
    program.set("u_bends", std::span<const float>(bends));
    program.set("u_breakStrains", std::span<const float>(strains));
    program.set("u_breakGains", std::span<const float>(gains));
}

} // namespace

Status CellPass::initialize(const SolverSetup& setup, const StateTextures& textures,
                            const std::vector<gpu::ShaderDefine>& defines, StepProgram& step, bool compute) {
    const TextureLayout& layout = textures.layout();
    const gpu::ShaderLibrary library;
    compute_ = compute;
    const std::vector<std::string> stages = compute
                                                ? std::vector<std::string>{"cell_terms.comp"}
                                                : std::vector<std::string>{"pass.vert", "cell_terms.frag"};
    SEROSA_ASSIGN(program_, gpu::Program::create(library, stages, defines));
    if (!compute)
        target_ = gpu::Framebuffer("cell terms");
    const char* samplers[] = {"t_cellX", "t_cellY", "t_cellZ"};
    const char* images[] = {"i_cellX", "i_cellY", "i_cellZ"};
    for (std::size_t column = 0; column < 3; ++column) {
        columns_[column] = gpu::Texture2D("cell terms", GL_RGBA32F, layout.width, layout.height);
        if (compute)
            program_.image(images[column], columns_[column], GL_WRITE_ONLY);
        else
            target_.attach(GLenum(GL_COLOR_ATTACHMENT0 + column), columns_[column]);
        if (column == 1 || setup.tissue.volumetric())
            step.texture(samplers[column], columns_[column]);
    }
    if (!compute) {
        target_.setDrawBuffers(3);
        emptyVertices_ = gpu::VertexArray("no attributes");
    }
    setMaterials(program_, setup.tissue);
    if (layout.kind == SRS_LAYOUT_ROWS) {
        program_.image("i_rowOffsetsA", textures.rowOffsets_[0], GL_READ_ONLY);
        program_.image("i_rowOffsetsB", textures.rowOffsets_[1], GL_READ_ONLY);
    }
    return {};
}

void CellPass::run(const StateTextures& textures) {
    program_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_ONLY);
    program_.image("i_positions", textures.positions(), GL_READ_ONLY);
    // Image loads are incoherent: what the last pass wrote must be visible first.
    if (compute_) {
        program_.dispatch({textures.layout().width, textures.layout().height, 1});
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
        return;
    }
    target_.bind(textures.layout().width, textures.layout().height);
    program_.use();
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
    gpu::drawFullScreen(emptyVertices_);
}

std::size_t CellPass::bytes() const {
    return columns_[0] ? 3 * 16 * std::size_t(columns_[0].width()) * std::size_t(columns_[0].height()) : 0;
}

} // namespace serosa::sim
