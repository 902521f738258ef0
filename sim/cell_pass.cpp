// See sim/cell_pass.h.
#include "sim/cell_pass.h"

#include "shaders/shared_constants.h"
#include "sim/tissue_uniforms.h"

#include <span>

namespace serosa::sim {

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
    const MaterialArrays materials(setup.tissue, setup.timeStep);
    materials.setVolume(program_);
    if (setup.tissue.stiffens()) {
        program_.set("u_springs", std::span<const float>(materials.springs));
        materials.setCurves(program_);
    }
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
