// See render/lattice_warp.h.
#include "render/lattice_warp.h"

#include "shaders/raycast_constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace serosa::render {

namespace {

/// As shaders/lattice_warp.glsl has it.
struct WarpCell {
    glm::vec4 rest; // of its lowest corner, lattice units
    std::array<std::uint32_t, 8> texels;
};
static_assert(sizeof(WarpCell) == 48);

/// As shaders/lattice_warp_box.glsl has it.
struct WarpBox {
    std::array<std::uint32_t, 6> bound;
    std::uint32_t sum;
    float way;
    glm::vec4 lowest, step;
    std::array<std::uint32_t, 3 * SRS_WARP_BINS> nodesIn;
};
static_assert(offsetof(WarpBox, lowest) == 32 && offsetof(WarpBox, nodesIn) == 64);

constexpr int kMostSides = 2;           // of cuts
constexpr double kMostStep = 1.5;       // of a voxel: times that at rest
constexpr std::int64_t kRoom = 1 << 20; // voxels

/// Voxels along each axis: what the organ takes at rest, and half of the longest side where all of it is not
/// too much: what is thin may turn or bend. A voxel to spare on either side.
glm::ivec3 sizeOf(const glm::dvec3& extent, double voxels) {
    const glm::ivec3 rest = glm::ivec3(glm::ceil(extent * voxels)) + 3;
    glm::ivec3 size = rest;
    for (int room = std::max({rest.x, rest.y, rest.z}) / 2; room > 0; --room) {
        size = glm::max(rest, room);
        if (std::int64_t(size.x) * size.y * size.z <= kRoom)
            break;
    }
    return size;
}

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
    const glm::ivec3 size = sizeOf(high - low, voxels);
    const int most = gpu::Texture3D::mostTexels();
    const int longest = std::max({size.x, size.y, kMostSides * size.z});
    if (longest > most)
        return Error{"a displacement texture of " + std::to_string(longest) +
                     " voxels along a side: the context has at most " + std::to_string(most)};
    made.cellCount_ = cells.size();
    made.nodeCount_ = nodes.size();
    made.cells_ = gpu::Buffer("cells of a displacement", std::span<const WarpCell>(cells));
    made.nodes_ = gpu::Buffer("nodes of a displacement", std::span<const std::uint32_t>(nodes));
    made.box_ = gpu::Buffer("box of a displacement", sizeof(WarpBox), nullptr);
    made.mostStep_ = kMostStep / voxels;
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
    std::vector<gpu::ShaderDefine> bins = defines;
    bins.push_back({"WARP_BINS", "1"});
    SEROSA_ASSIGN(made.bins, gpu::Program::create(library, {"lattice_warp_bounds.comp"}, bins));
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
    owner_ =
        gpu::Texture3D("owners of a displacement's voxels", GL_R32UI, size() * glm::ivec3(1, 1, kMostSides));
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
    const int sides = mask ? kMostSides : 1;
    const auto barrier = [] {
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                        GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                        GL_TEXTURE_UPDATE_BARRIER_BIT);
    };
    WarpBox empty{};
    empty.bound = {0xffffffffu, 0xffffffffu, 0xffffffffu, 0, 0, 0};
    barrier(); // pictures before, which asked for it
    box_.upload(0, sizeof(empty), &empty);
    owner_.clear(0xffffffffu);
    for (gpu::Program* const program : {&programs.bounds, &programs.bins}) {
        program->set("u_nodes", int(nodeCount_)).buffer("b_nodes", nodes_).buffer("b_box", box_);
        if (program == &programs.bins)
            program->set("u_size", size()).set("u_mostStep", float(mostStep_));
        for (int side = 0; side < sides; ++side) {
            program->texture("t_positions", !mask       ? state.positions()
                                            : side == 0 ? sideNodes_->above()
                                                        : sideNodes_->below());
            program->dispatch({int(nodeCount_), 1, 1});
        }
        barrier();
    }
    if (steps > 0) {
        ways_.set("u_nodes", int(nodeCount_)).buffer("b_nodes", nodes_).buffer("b_box", box_);
        ways_.texture("t_increments", state.increments());
        ways_.dispatch({int(nodeCount_), 1, 1});
    }
    barrier();
    frame_.set("u_size", size()).set("u_mostStep", float(mostStep_)).buffer("b_box", box_);
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
    box_.download(offsetof(WarpBox, lowest), sizeof(frame), frame);
    read.lowest = glm::dvec3(frame[0]);
    read.step = glm::dvec3(frame[1]);
    read.texels.resize(std::size_t(size().x) * std::size_t(size().y) * std::size_t(size().z));
    sides_[side].download(GL_RGBA, GL_FLOAT, read.texels.size() * sizeof(glm::vec4), read.texels.data());
    return read;
}

} // namespace serosa::render
