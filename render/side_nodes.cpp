// See render/side_nodes.h.
#include "render/side_nodes.h"

#include "shaders/shared_constants.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace serosa::render {

namespace {

constexpr int kMostDims = 1024; // a place in the grid packs in ten bits an axis

} // namespace

Result<SideNodes> SideNodes::create(const sim::Lattice& lattice, const sim::TextureLayout& layout) {
    if (std::max({lattice.nodeDims.x, lattice.nodeDims.y, lattice.nodeDims.z}) > kMostDims)
        return Error{"a cut lattice of more than " + std::to_string(kMostDims) +
                     " nodes along an axis: raise its spacing"};
    SideNodes made;
    SEROSA_ASSIGN(made.find_, gpu::Program::create(gpu::ShaderLibrary(), {"side_nodes_find.comp"}));
    SEROSA_ASSIGN(made.program_, gpu::Program::create(gpu::ShaderLibrary(), {"side_nodes.comp"}));
    std::vector<glm::uvec4> nodes;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const glm::uvec2& at = layout.texelOfNode[node];
        const glm::uvec3 grid(lattice.nodes[node]);
        nodes.emplace_back(at.y << 16 | at.x, grid.x | grid.y << 10 | grid.z << 20, lattice.connections[node],
                           0);
    }
    made.count_ = int(nodes.size());
    made.dims_ = lattice.nodeDims;
    made.centre_ = lattice.centre;
    made.nodes_ = gpu::Buffer("nodes beside cuts", std::span<const glm::uvec4>(nodes));
    made.grid_ = gpu::Buffer("grid of nodes beside cuts", std::span<const std::int32_t>(lattice.nodeOfGrid));
    made.sides_ = gpu::Buffer("sides of nodes beside cuts", sizeof(float) * nodes.size(), nullptr);
    made.above_ = gpu::Texture2D("nodes above cuts", GL_RGBA32F, layout.width, layout.height);
    made.below_ = gpu::Texture2D("nodes below cuts", GL_RGBA32F, layout.width, layout.height);
    return made;
}

void SideNodes::update(const sim::StateTextures& state, const CutMask& mask) {
    std::array<int, 3 * SRS_NEIGHBOURS> offsets{};
    for (std::size_t i = 0; i < offsets.size(); ++i)
        offsets[i] = sim::kNeighbourOffsets[i / 3][int(i % 3)];
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT); // steps, the mask's paint, pictures before
    for (gpu::Program* const one : {&find_, &program_}) {
        one->texture("t_nodeInfo", state.nodeInfo()).buffer("b_nodes", nodes_).buffer("b_grid", grid_);
        one->set("u_nodeCount", count_).set("u_dims", dims_);
        one->set("u_offsets", std::span<const int>(offsets));
    }
    find_.buffer("b_sides", mask.sides()).buffer("b_found", sides_);
    find_.dispatch({count_, 1, 1});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    program_.texture("t_positions", state.positions()).buffer("b_sides", sides_).set("u_centre", centre_);
    program_.image("i_above", above_, GL_WRITE_ONLY).image("i_below", below_, GL_WRITE_ONLY);
    program_.dispatch({count_, 1, 1});
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

} // namespace serosa::render
