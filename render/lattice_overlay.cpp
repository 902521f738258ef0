#include "render/lattice_overlay.h"

#include "gpu/gl.h"

#include <algorithm>
#include <set>

namespace serosa::render {

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

Pair ordered(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

/// Springs that lie in outer faces: their four edges and both diagonals. Each boundary triangle is half a
/// face; its longest edge is one diagonal, and the corner across it, mirrored, gives the other.
std::set<Pair> springsOfBoundary(const sim::Lattice& lattice) {
    std::set<Pair> springs;
    for (const glm::uvec3& t : lattice.boundary)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[(i + 1) % 3], corner = t[(i + 2) % 3];
            springs.insert(ordered(a, b));
            const glm::ivec3 along = lattice.nodes[b] - lattice.nodes[a];
            if (glm::dot(glm::vec3(along), glm::vec3(along)) < 1.5F)
                continue;
            const auto across = lattice.nodeAt(lattice.nodes[a] + lattice.nodes[b] - lattice.nodes[corner]);
            if (across >= 0)
                springs.insert(ordered(corner, std::uint32_t(across)));
        }
    return springs;
}

constexpr std::uint32_t kDiagonalBit = 1U << 31;
constexpr int kFirstDiagonal = 6; // of kNeighbourOffsets

} // namespace

Result<gpu::Program> LatticeOverlay::compile(const gpu::ShaderLibrary& library) {
    return gpu::Program::create(library, {"lattice.vert", "lattice.frag"}, {{"MAPPING_BASIS", "0"}});
}

Result<LatticeOverlay> LatticeOverlay::create(const sim::Lattice& lattice, const sim::TextureLayout& layout) {
    LatticeOverlay overlay;
    SEROSA_ASSIGN(overlay.program_, compile(gpu::ShaderLibrary()));
    const auto texel = [&](std::size_t node) {
        return layout.texelOfNode[node].y << 16 | layout.texelOfNode[node].x;
    };
    const std::set<Pair> outer = springsOfBoundary(lattice);
    std::vector<glm::uvec2> springs, nodes;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < int(sim::kNeighbourOffsets.size()); d += 2) { // one of each pair of opposites
            const std::int64_t other = lattice.neighbour(node, d);
            if (other >= 0 && outer.contains(ordered(std::uint32_t(node), std::uint32_t(other))))
                springs.emplace_back(texel(node) | (d >= kFirstDiagonal ? kDiagonalBit : 0U),
                                     texel(std::size_t(other)));
        }
    std::vector<bool> isOuter(lattice.nodeCount(), false);
    for (const glm::uvec3& t : lattice.boundary)
        for (int i = 0; i < 3; ++i)
            isOuter[t[i]] = true;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        if (isOuter[node])
            nodes.emplace_back(texel(node), texel(node));
    overlay.springs_ = int(springs.size());
    overlay.nodes_ = int(nodes.size());

    const auto fill = [](gpu::VertexArray& array, gpu::Buffer& buffer, const std::string& label,
                         const std::vector<glm::uvec2>& items) {
        buffer = gpu::Buffer(label, std::span(items));
        array = gpu::VertexArray(label);
        array.integerAttribute(0, buffer, 2, GL_UNSIGNED_INT, sizeof(glm::uvec2), 0);
        glVertexArrayBindingDivisor(array.id(), 0, 1); // one an instance
    };
    fill(overlay.springArray_, overlay.springBuffer_, "lattice springs", springs);
    fill(overlay.nodeArray_, overlay.nodeBuffer_, "lattice nodes", nodes);
    return overlay;
}

void LatticeOverlay::draw(const sim::StateTextures& state, const Frame& frame, Ink ink) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDisable(GL_CULL_FACE);
    const float scale = std::max(1.0F, frame.size.y / 960);
    const glm::vec4 light(0.80F, 0.82F, 0.78F, 0.6F), dark(0.012F, 0.014F, 0.018F, 0.85F);
    program_.texture("t_positions", state.positions());
    program_.set("u_clipFromLattice", frame.clipFromLattice)
        .set("u_eye", frame.eye)
        .set("u_size", frame.size);
    program_.set("u_colour", ink == Ink::light ? light : dark);
    program_.set("u_lift", 0.06F).set("u_width", 1.1F * scale).set("u_diagonal", 0.3F);
    program_.use();
    glBindVertexArray(springArray_.id());
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, springs_);
    program_.set("u_lift", 0.09F).set("u_width", 3.6F * scale);
    program_.set("u_colour", ink == Ink::light ? glm::vec4(1.0F, 0.86F, 0.45F, 1.0F) : dark);
    program_.use();
    glBindVertexArray(nodeArray_.id());
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, nodes_);
    glEnable(GL_CULL_FACE);
    glDisable(GL_BLEND);
}

} // namespace serosa::render
