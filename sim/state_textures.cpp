// Upload and readback of a lattice's state textures (formats: sim/state_textures.h, ARCHITECTURE.md).
#include "sim/state_textures.h"

#include "shaders/shared_constants.h"
#include "sim/solver.h"

#include <array>
#include <bit>

namespace serosa::sim {

namespace {

std::array<std::uint32_t, 4> nodeInfoTexel(const Lattice& lattice, std::size_t node, bool fixed) {
    const auto& fills = lattice.fills[node];
    const auto pack = [&fills](std::size_t from) {
        return std::uint32_t(fills[from]) | std::uint32_t(fills[from + 1]) << 8 |
               std::uint32_t(fills[from + 2]) << 16 | std::uint32_t(fills[from + 3]) << 24;
    };
    return {lattice.connections[node] | std::uint32_t(lattice.depthSteps[node]) << SRS_DEPTH_SHIFT |
                SRS_FLAG_ACTIVE | (fixed ? SRS_FLAG_FIXED : 0u),
            pack(0), pack(4), 0u};
}

/// Materials of the eight cells around each node, 4 bits each.
std::vector<std::uint32_t> materialsAround(const Lattice& lattice) {
    std::vector<std::uint32_t> materials;
    const std::vector<std::int32_t> cells = cellsAround(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        std::uint32_t word = 0;
        for (std::size_t octant = 0; octant < 8; ++octant)
            if (const std::int32_t cell = cells[8 * node + octant]; cell >= 0)
                word |= std::uint32_t(lattice.cells[std::size_t(cell)].material) << (4 * octant);
        materials.push_back(word);
    }
    return materials;
}

} // namespace

Result<StateTextures> StateTextures::create(const Lattice& lattice, const std::vector<bool>& fixed,
                                            int layoutKind) {
    GLint maxSize = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &maxSize);
    StateTextures textures;
    SEROSA_ASSIGN(textures.layout_, makeTextureLayout(lattice, layoutKind, maxSize));
    const TextureLayout& layout = textures.layout_;
    for (int i = 0; i < 2; ++i) {
        textures.positions_[i] = gpu::Texture2D("positions", GL_RGBA32F, layout.width, layout.height);
        textures.increments_[i] = gpu::Texture2D("increments", GL_RGBA32F, layout.width, layout.height);
        textures.nodeInfo_[i] = gpu::Texture2D("node info", GL_RGBA32UI, layout.width, layout.height);
        // Texels without a node are never drawn to in some layouts of the future: start from zero, not from
        // garbage.
        textures.positions_[i].clear(glm::vec4(0));
        textures.increments_[i].clear(glm::vec4(0));
    }
    if (layout.kind == SRS_LAYOUT_ROWS) {
        std::vector<std::int32_t> half(layout.texels() * 4);
        for (std::size_t part = 0; part < 2; ++part) {
            for (std::size_t texel = 0; texel < layout.texels(); ++texel)
                for (std::size_t i = 0; i < 4; ++i)
                    half[texel * 4 + i] = layout.rowOffsets[texel * 8 + part * 4 + i];
            textures.rowOffsets_[part] =
                gpu::Texture2D("row offsets", GL_RGBA32UI, layout.width, layout.height);
            textures.rowOffsets_[part].upload(half.data());
        }
    }
    textures.info_.assign(layout.texels(), {0, 0, 0, 0});
    const std::vector<std::uint32_t> materials = materialsAround(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        auto& info = textures.info_[textures.linearTexel(node)];
        info = nodeInfoTexel(lattice, node, !fixed.empty() && fixed[node]);
        info[3] = materials[node];
    }
    textures.upload(restState(lattice));
    return textures;
}

std::size_t StateTextures::linearTexel(std::size_t node) const {
    return std::size_t(layout_.texelOfNode[node].y) * std::size_t(layout_.width) +
           layout_.texelOfNode[node].x;
}

void StateTextures::keepEarlier() {
    earlier_ = gpu::Texture2D("earlier increments", GL_RGBA32F, layout_.width, layout_.height);
    earlier_.clear(glm::vec4(0));
}

void StateTextures::upload(const LatticeState& state) {
    SEROSA_CHECK(state.positions.size() == layout_.texelOfNode.size(), "a state of this lattice");
    SEROSA_CHECK(state.connections.empty() || state.connections.size() == state.positions.size(),
                 "connections of every node or of none");
    std::vector<glm::vec4> positions(layout_.texels(), glm::vec4(0)),
        increments(layout_.texels(), glm::vec4(0));
    std::vector<std::array<std::uint32_t, 4>> info = info_;
    for (std::size_t node = 0; node < state.positions.size(); ++node) {
        const std::size_t texel = linearTexel(node);
        positions[texel] =
            glm::vec4(glm::vec3(state.positions[node]), std::bit_cast<float>(state.normals[node]));
        increments[texel] = glm::vec4(glm::vec3(state.increments[node]), 0);
        if (!state.connections.empty())
            info[texel][0] = (info[texel][0] & ~SRS_CONNECTION_MASK) | state.connections[node];
        info[texel][0] |= (state.heldBy[node] & SRS_HELD_MASK) << SRS_HELD_SHIFT;
    }
    positions_[current_].upload(positions.data());
    increments_[current_].upload(increments.data());
    nodeInfo_[currentInfo_].upload(info.data());
    if (!earlier_)
        return;
    std::vector<glm::vec4> earlier(layout_.texels(), glm::vec4(0));
    for (std::size_t node = 0; node < state.earlier.size(); ++node)
        earlier[linearTexel(node)] = glm::vec4(state.earlier[node]);
    earlier_.upload(earlier.data());
}

LatticeState StateTextures::download(std::int64_t step) const {
    std::vector<glm::vec4> positions(layout_.texels()), increments(layout_.texels());
    std::vector<std::array<std::uint32_t, 4>> info(layout_.texels());
    positions_[current_].download(positions.data(), positions.size() * sizeof positions[0]);
    increments_[current_].download(increments.data(), increments.size() * sizeof increments[0]);
    nodeInfo_[currentInfo_].download(info.data(), info.size() * sizeof info[0]);
    LatticeState state;
    state.step = step;
    bool cut = false;
    for (std::size_t node = 0; node < layout_.texelOfNode.size(); ++node) {
        const std::size_t texel = linearTexel(node);
        state.positions.emplace_back(positions[texel]);
        state.increments.emplace_back(increments[texel]);
        state.normals.push_back(std::bit_cast<std::uint32_t>(positions[texel].w));
        state.heldBy.push_back((info[texel][0] >> SRS_HELD_SHIFT) & SRS_HELD_MASK);
        state.connections.push_back(info[texel][0] & SRS_CONNECTION_MASK);
        cut = cut || state.connections.back() != (info_[texel][0] & SRS_CONNECTION_MASK);
    }
    if (!cut)
        state.connections.clear();
    if (earlier_) {
        earlier_.download(positions.data(), positions.size() * sizeof positions[0]);
        for (std::size_t node = 0; node < layout_.texelOfNode.size(); ++node)
            state.earlier.emplace_back(positions[linearTexel(node)]);
    }
    return state;
}

std::vector<std::uint32_t> StateTextures::downloadConnections() const {
    std::vector<std::array<std::uint32_t, 4>> info(layout_.texels());
    nodeInfo_[currentInfo_].download(info.data(), info.size() * sizeof info[0]);
    std::vector<std::uint32_t> connections;
    for (std::size_t node = 0; node < layout_.texelOfNode.size(); ++node)
        connections.push_back(info[linearTexel(node)][0] & SRS_CONNECTION_MASK);
    return connections;
}

std::size_t StateTextures::bytes() const {
    const std::size_t perTexel =
        2 * (16 + 16 + 16) + (layout_.kind == SRS_LAYOUT_ROWS ? 32 : 0) + (earlier_ ? 16 : 0);
    return layout_.texels() * perTexel;
}

} // namespace serosa::sim
