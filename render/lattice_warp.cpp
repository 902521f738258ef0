// See render/lattice_warp.h.
#include "render/lattice_warp.h"

#include "shaders/raycast_constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace serosa::render {

namespace {

/// As shaders/lattice_warp.glsl has it.
struct WarpCell {
    glm::vec4 rest; // of its lowest corner, lattice units
    std::array<std::uint32_t, 8> texels;
};
static_assert(sizeof(WarpCell) == 48);

constexpr std::size_t kBoxBytes =
    6 * sizeof(std::uint32_t) + 2 * sizeof(std::uint32_t) + 2 * sizeof(glm::vec4);

} // namespace

Result<LatticeWarp> LatticeWarp::create(const sim::Lattice& lattice, const sim::TextureLayout& layout,
                                        double voxels) {
    if (lattice.cells.size() > SRS_WARP_MOST_CELLS)
        return Error{"a lattice of " + std::to_string(lattice.cells.size()) +
                     " cells has no displacement texture: at most " + std::to_string(SRS_WARP_MOST_CELLS)};
    LatticeWarp made;
    const auto texelOf = [&](std::size_t node) {
        const glm::uvec2& at = layout.texelOfNode[node];
        return at.y << 16 | at.x;
    };
    std::vector<WarpCell> cells;
    for (const sim::LatticeCell& cell : lattice.cells) {
        WarpCell one{};
        for (int corner = 0; corner < 8; ++corner) {
            const auto node = std::size_t(lattice.nodeAt(cell.grid + sim::cornerOffset(corner)));
            one.texels[std::size_t(corner)] = texelOf(node);
            if (corner == 0)
                one.rest = glm::vec4(glm::vec3(lattice.restPosition(node)), 0);
        }
        cells.push_back(one);
    }
    std::vector<std::uint32_t> nodes;
    glm::dvec3 low(0), high(0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        nodes.push_back(texelOf(node));
        low = node ? glm::min(low, lattice.restPosition(node)) : lattice.restPosition(node);
        high = node ? glm::max(high, lattice.restPosition(node)) : lattice.restPosition(node);
    }
    const glm::ivec3 size = glm::ivec3(glm::ceil((high - low) * voxels)) + 3;
    GLint most = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
    if (std::max({size.x, size.y, size.z}) > most)
        return Error{"a displacement texture of " + std::to_string(std::max({size.x, size.y, size.z})) +
                     " voxels along a side: the context has at most " + std::to_string(most)};
    made.cellCount_ = cells.size();
    made.nodeCount_ = nodes.size();
    made.cells_ = gpu::Buffer("cells of a displacement", std::span<const WarpCell>(cells));
    made.nodes_ = gpu::Buffer("nodes of a displacement", std::span<const std::uint32_t>(nodes));
    made.box_ = gpu::Buffer("box of a displacement", kBoxBytes, nullptr);
    made.sides_[0] = gpu::Texture3D("displacement of a lattice", GL_RGBA32F, size);
    made.owner_ = gpu::Texture3D("owners of a displacement's voxels", GL_R32UI, size);
    made.lattice_ = &lattice;
    made.layout_ = &layout;
    SEROSA_ASSIGN(made.frame_, gpu::Program::create(gpu::ShaderLibrary(), {"lattice_warp_bounds.comp"},
                                                    {{"WARP_FRAME", "1"}}));
    SEROSA_ASSIGN(made.ways_, gpu::Program::create(gpu::ShaderLibrary(), {"lattice_warp_bounds.comp"},
                                                   {{"WARP_WAYS", "1"}}));
    SEROSA_ASSIGN(made.whole_, compile({}));
    return made;
}

Result<LatticeWarp::Programs> LatticeWarp::compile(const std::vector<gpu::ShaderDefine>& defines) {
    const gpu::ShaderLibrary library;
    Programs made;
    SEROSA_ASSIGN(made.bounds, gpu::Program::create(library, {"lattice_warp_bounds.comp"}, defines));
    SEROSA_ASSIGN(made.claim, gpu::Program::create(library, {"lattice_warp_claim.comp"}, defines));
    SEROSA_ASSIGN(made.write, gpu::Program::create(library, {"lattice_warp_write.comp"}, defines));
    return made;
}

Status LatticeWarp::openSides() {
    SEROSA_ASSIGN(Programs programs, compile({{"WARP_CUT", "1"}}));
    SEROSA_ASSIGN(SideNodes nodes, SideNodes::create(*lattice_, *layout_));
    cut_.emplace(std::move(programs));
    sideNodes_.emplace(std::move(nodes));
    sides_[1] = gpu::Texture3D("displacement below cuts", GL_RGBA32F, size());
    owner_ = gpu::Texture3D("owners of a displacement's voxels", GL_R32UI, size() * glm::ivec3(1, 1, 2));
    return {};
}

void LatticeWarp::setNodes(gpu::Program& program, const sim::StateTextures& state) const {
    if (mask_)
        program.texture("t_above", sideNodes_->above()).texture("t_below", sideNodes_->below());
    else
        program.texture("t_positions", state.positions());
    program.buffer("b_cells", cells_).buffer("b_box", box_);
}

Status LatticeWarp::update(const sim::StateTextures& state, const CutMask* mask, int steps) {
    if (mask && !cut_)
        SEROSA_TRY(openSides());
    mask_ = mask;
    if (mask)
        sideNodes_->update(state, *mask);
    Programs& programs = mask ? *cut_ : whole_;
    const int sides = mask ? 2 : 1;
    const auto barrier = [] {
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                        GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    };
    constexpr std::uint32_t kEmpty[8] = {0xffffffffu, 0xffffffffu, 0xffffffffu, 0, 0, 0, 0, 0};
    box_.upload(0, sizeof(kEmpty), kEmpty);
    owner_.clear(0xffffffffu);
    for (int side = 0; side < sides; ++side) {
        programs.bounds.set("u_nodes", int(nodeCount_)).buffer("b_nodes", nodes_).buffer("b_box", box_);
        programs.bounds.texture("t_positions", !mask       ? state.positions()
                                               : side == 0 ? sideNodes_->above()
                                                           : sideNodes_->below());
        programs.bounds.dispatch({int(nodeCount_), 1, 1});
    }
    if (steps > 0) {
        ways_.set("u_nodes", int(nodeCount_)).buffer("b_nodes", nodes_).buffer("b_box", box_);
        ways_.texture("t_increments", state.increments());
        ways_.dispatch({int(nodeCount_), 1, 1});
    }
    barrier();
    frame_.set("u_size", size()).buffer("b_box", box_);
    frame_.set("u_wayShare", float(steps / (SRS_WAY_UNITS * double(nodeCount_))));
    frame_.dispatch({1, 1, 1});
    barrier();
    setNodes(programs.claim, state);
    programs.claim.set("u_size", size()).set("u_cells", int(cellCount_));
    programs.claim.image("i_owner", owner_, GL_READ_WRITE);
    const int groups = int(std::min<std::size_t>(cellCount_, 60000)); // one a cell
    programs.claim.dispatch({SRS_WARP_GROUP * groups, 1, 1});
    barrier();
    setNodes(programs.write, state);
    for (int side = 0; side < sides; ++side) {
        programs.write.set("u_size", size()).set("u_side", side);
        programs.write.image("i_owner", owner_, GL_READ_ONLY);
        programs.write.image("i_displacement", sides_[std::size_t(side)], GL_WRITE_ONLY);
        programs.write.dispatch(size());
    }
    barrier();
    return {};
}

void LatticeWarp::bind(gpu::Program& program) const {
    program.texture("t_lattice", sides_[0]).buffer("b_box", box_);
    if (!mask_)
        return;
    program.texture("t_latticeBelow", sides_[1]);
    mask_->bind(program);
}

LatticeWarp::Read LatticeWarp::read(std::size_t side) const {
    glFinish();
    Read read;
    glm::vec4 frame[2];
    box_.download(kBoxBytes - sizeof(frame), sizeof(frame), frame);
    read.lowest = glm::dvec3(frame[0]);
    read.step = glm::dvec3(frame[1]);
    read.texels.resize(std::size_t(size().x) * std::size_t(size().y) * std::size_t(size().z));
    sides_[side].download(GL_RGBA, GL_FLOAT, read.texels.size() * sizeof(glm::vec4), read.texels.data());
    return read;
}

} // namespace serosa::render
