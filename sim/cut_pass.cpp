// See sim/cut_pass.h. Node info is rewritten ping-pong, as taking hold of nodes does.
#include "sim/cut_pass.h"

#include "shaders/shared_constants.h"
#include "sim/cut_list.h"

#include <array>
#include <bit>

namespace serosa::sim {

static_assert(int(StrokeKind::blade) == SRS_STROKE_BLADE &&
                  int(StrokeKind::cauterize) == SRS_STROKE_CAUTERIZE &&
                  int(StrokeKind::tear) == SRS_STROKE_TEAR,
              "the shader's words for kinds of strokes");

Status CutPass::initialize(const StateTextures& textures) {
    if (cutProgram_)
        return {};
    const TextureLayout& layout = textures.layout();
    const std::vector<gpu::ShaderDefine> defines = {
        {"SRS_LAYOUT", std::to_string(layout.kind)},
        {"SRS_GRID_NY", std::to_string(layout.gridStride.z)},
        {"SRS_ROW_LOG2", std::to_string(std::countr_zero(unsigned(layout.width)))}};
    const gpu::ShaderLibrary library;
    SEROSA_ASSIGN(cutProgram_, gpu::Program::create(library, {"pass.vert", "cut.frag"}, defines));
    SEROSA_ASSIGN(undoProgram_, gpu::Program::create(library, {"pass.vert", "undo_cut.frag"}));
    SEROSA_ASSIGN(pieceProgram_, gpu::Program::create(library, {"pass.vert", "pieces.frag"}, defines));
    if (layout.kind == SRS_LAYOUT_ROWS)
        for (gpu::Program* program : {&cutProgram_, &pieceProgram_}) {
            program->image("i_rowOffsetsA", textures.rowOffsets_[0], GL_READ_ONLY);
            program->image("i_rowOffsetsB", textures.rowOffsets_[1], GL_READ_ONLY);
        }
    changed_ = gpu::Texture2D("piece labels changed", GL_R32UI, 1, 1);
    for (std::size_t i = 0; i < 2; ++i) {
        infoTargets_[i] = gpu::Framebuffer("cut target");
        infoTargets_[i].attach(GL_COLOR_ATTACHMENT0, textures.nodeInfo_[i]);
        infoTargets_[i].setDrawBuffers(1);
        labels_[i] = gpu::Texture2D("piece labels", GL_R32UI, layout.width, layout.height);
        labelTargets_[i] = gpu::Framebuffer("piece labels target");
        labelTargets_[i].attach(GL_COLOR_ATTACHMENT0, labels_[i]);
        labelTargets_[i].setDrawBuffers(1);
    }
    emptyVertices_ = gpu::VertexArray("no attributes");
    return {};
}

void CutPass::rewriteInfo(StateTextures& textures, gpu::Program& program) {
    const int to = 1 - textures.currentInfo_;
    program.image("i_nodeInfo", textures.nodeInfo(), GL_READ_ONLY);
    infoTargets_[std::size_t(to)].bind(textures.layout().width, textures.layout().height);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    program.use();
    // Of whatever pass wrote positions, info and layer last, a render target or an image.
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    gpu::drawFullScreen(emptyVertices_);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    textures.currentInfo_ = to;
}

Status CutPass::cut(StateTextures& textures, const Lattice& lattice, const Stroke& stroke) {
    SEROSA_TRY(initialize(textures));
    if (!stroke.continues || layers_.empty()) {
        layers_.emplace_back("cut by a stroke", GL_R32UI, textures.layout().width, textures.layout().height);
        layers_.back().clear(glm::uvec4(0));
    }
    const LatticeStroke local = toLattice(stroke, lattice);
    std::array<glm::vec4, 4> corners;
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = glm::vec4(local.corners[i], 0);
    cutProgram_.set("u_kind", int(local.kind));
    cutProgram_.set("u_corners", std::span<const glm::vec4>(corners));
    cutProgram_.set("u_size", local.size);
    cutProgram_.image("i_positions", textures.positions(), GL_READ_ONLY);
    cutProgram_.image("i_cleared", layers_.back(), GL_READ_WRITE);
    rewriteInfo(textures, cutProgram_);
    return {};
}

bool CutPass::undo(StateTextures& textures) {
    if (layers_.empty())
        return false;
    undoProgram_.image("i_cleared", layers_.back(), GL_READ_ONLY);
    rewriteInfo(textures, undoProgram_);
    layers_.pop_back();
    return true;
}

std::vector<CutLayer> CutPass::layers(const StateTextures& textures) const {
    const TextureLayout& layout = textures.layout();
    std::vector<CutLayer> all;
    std::vector<std::uint32_t> texels(layout.texels()), words(layout.texelOfNode.size());
    for (const gpu::Texture2D& layer : layers_) {
        layer.download(texels.data(), texels.size() * sizeof texels[0]);
        for (std::size_t node = 0; node < words.size(); ++node)
            words[node] = texels[textures.linearTexel(node)];
        all.push_back(cutLayerOf(words));
    }
    return all;
}

Status CutPass::setLayers(const StateTextures& textures, const std::vector<CutLayer>& layers) {
    layers_.clear();
    if (layers.empty())
        return {};
    SEROSA_TRY(initialize(textures));
    const TextureLayout& layout = textures.layout();
    for (const CutLayer& layer : layers) {
        std::vector<std::uint32_t> texels(layout.texels(), 0u);
        for (const ClearedBits& cleared : layer)
            texels[textures.linearTexel(cleared.node)] = cleared.bits;
        layers_.emplace_back("cut by a stroke", GL_R32UI, layout.width, layout.height);
        layers_.back().upload(texels.data());
    }
    return {};
}

Result<std::vector<std::uint32_t>> CutPass::pieces(const StateTextures& textures) {
    SEROSA_TRY(initialize(textures));
    const TextureLayout& layout = textures.layout();
    pieceProgram_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_ONLY);
    pieceProgram_.image("i_changed", changed_, GL_WRITE_ONLY);
    pieceProgram_.set("u_width", layout.width);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    std::size_t from = 0;
    std::uint32_t changed = 1;
    for (int pass = 0; changed != 0; ++pass) {
        constexpr int kCheckEvery = 8; // passes between two looks at whether one changed a label
        const bool look = pass % kCheckEvery == kCheckEvery - 1;
        if (look)
            changed_.clear(glm::uvec4(0));
        pieceProgram_.set("u_first", pass == 0 ? 1 : 0);
        pieceProgram_.image("i_labels", labels_[from], GL_READ_ONLY);
        labelTargets_[1 - from].bind(layout.width, layout.height);
        pieceProgram_.use();
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        gpu::drawFullScreen(emptyVertices_);
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        if (look)
            changed_.download(&changed, sizeof changed);
        from = 1 - from;
    }
    std::vector<std::uint32_t> texels(layout.texels()), nodeOfTexel(layout.texels(), 0), labels;
    labels_[from].download(texels.data(), texels.size() * sizeof texels[0]);
    for (std::size_t node = 0; node < layout.texelOfNode.size(); ++node)
        nodeOfTexel[textures.linearTexel(node)] = std::uint32_t(node);
    for (std::size_t node = 0; node < layout.texelOfNode.size(); ++node)
        labels.push_back(nodeOfTexel[texels[textures.linearTexel(node)]]);
    return labels;
}

} // namespace serosa::sim
