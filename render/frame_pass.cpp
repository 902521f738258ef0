// See render/frame_pass.h.
#include "render/frame_pass.h"

#include "gpu/gl.h"
#include "shaders/mapping_constants.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace serosa::render {

Result<FramePass> FramePass::create(const FrameStencil& stencil, const sim::TextureLayout& layout) {
    FramePass pass;
    SEROSA_ASSIGN(pass.program_, gpu::Program::create(gpu::ShaderLibrary(), {"node_frames.comp"}));
    pass.frames_ = gpu::Texture2D("node frames", GL_RG32UI, layout.width, layout.height);
    pass.update(stencil, layout);
    return pass;
}

void FramePass::update(const FrameStencil& stencil, const sim::TextureLayout& layout) {
    const auto texel = [&layout](std::uint32_t node) {
        const glm::uvec2& at = layout.texelOfNode[node];
        return at.y << 16 | at.x;
    };
    std::vector<glm::uvec4> rows, terms;
    for (const FrameStencil::Row& row : stencil.rows)
        rows.emplace_back(texel(row.node), texel(row.centre), row.begin, row.count);
    for (const FrameStencil::Term& term : stencil.terms)
        terms.emplace_back(std::bit_cast<std::uint32_t>(term.gradient.x),
                           std::bit_cast<std::uint32_t>(term.gradient.y),
                           std::bit_cast<std::uint32_t>(term.gradient.z), texel(term.node));
    rows_ = gpu::Buffer("node frame rows", std::span<const glm::uvec4>(rows));
    const std::size_t height =
        std::max<std::size_t>(1, (terms.size() + SRS_TABLE_WIDTH - 1) / SRS_TABLE_WIDTH);
    terms.resize(height * SRS_TABLE_WIDTH);
    terms_ = gpu::Texture2D("node frame terms", GL_RGBA32UI, SRS_TABLE_WIDTH, int(height));
    terms_.upload(terms.data());
    count_ = int(rows.size());
    program_.buffer("b_rows", rows_).texture("t_terms", terms_);
    program_.image("i_frames", frames_, GL_WRITE_ONLY);
    program_.set("u_rows", count_);
}

void FramePass::run(const gpu::Texture2D& positions) {
    program_.texture("t_positions", positions);
    program_.dispatch({count_, 1, 1});
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

} // namespace serosa::render
