// See render/cut_sides.h.
#include "render/cut_sides.h"

#include "render/triangle_basis.h"
#include "render/triangle_choice.h"
#include "shaders/mapping_constants.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace serosa::render {

namespace {

constexpr int kNearSprings = 2;     // around what a cut touched
constexpr int kTogetherSprings = 4; // between nodes of one side
constexpr double kReach = 3;        // spacings to another triangle
constexpr double kFacing = 0.1;     // least cosine between the normals of the old and the new one

} // namespace

CutSides::CutSides(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections)
    : lattice_(lattice), connections_(connections), near_(lattice.nodeCount()) {
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        near_[node] = connections[node] != lattice.connections[node];
    for (int ring = 0; ring < kNearSprings; ++ring) {
        const std::vector<bool> inner = near_;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            for (int d = 0; d < 18 && inner[node]; ++d)
                if (const std::int64_t other = lattice.neighbour(node, d); other >= 0)
                    near_[std::size_t(other)] = true;
    }
}

bool CutSides::parted(std::uint32_t a, std::uint32_t b) const {
    const glm::ivec3 offset = lattice_.nodes[b] - lattice_.nodes[a];
    for (std::size_t d = 0; d < sim::kNeighbourOffsets.size(); ++d)
        if (sim::kNeighbourOffsets[d] == offset)
            return ((lattice_.connections[a] & ~connections_[a]) >> d) & 1U;
    return false;
}

bool CutSides::isWhole(const glm::uvec3& nodes) const {
    return !parted(nodes.x, nodes.y) && !parted(nodes.y, nodes.z) && !parted(nodes.z, nodes.x);
}

bool CutSides::joined(Around& around, const std::vector<std::uint32_t>& connections, std::uint32_t a,
                      std::uint32_t b) const {
    if (a == b)
        return true;
    const auto [it, fresh] = around.try_emplace(a);
    std::vector<std::uint32_t>& nodes = it->second;
    if (fresh) {
        nodes = {a};
        std::size_t begin = 0;
        for (int step = 0; step < kTogetherSprings; ++step) {
            const std::size_t end = nodes.size();
            for (std::size_t i = begin; i < end; ++i)
                for (int d = 0; d < 18; ++d)
                    if ((connections[nodes[i]] >> d) & 1U)
                        nodes.push_back(std::uint32_t(lattice_.neighbour(nodes[i], d)));
            std::sort(nodes.begin() + std::ptrdiff_t(end), nodes.end());
            nodes.erase(std::unique(nodes.begin() + std::ptrdiff_t(end), nodes.end()), nodes.end());
            begin = end;
        }
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    }
    return std::binary_search(nodes.begin(), nodes.end(), b);
}

bool CutSides::together(std::uint32_t a, std::uint32_t b) {
    return joined(around_, connections_, a, b);
}

bool CutSides::isHeld(const glm::uvec3& nodes) const {
    return !isLoose(nodes.x) && !isLoose(nodes.y) && !isLoose(nodes.z) && isWhole(nodes);
}

bool CutSides::isFirm(const glm::uvec3& nodes) const {
    for (int i = 0; i < 3; ++i)
        if (2 * std::popcount(connections_[nodes[i]]) < std::popcount(lattice_.connections[nodes[i]]))
            return false;
    return true;
}

std::optional<std::uint32_t> CutSides::nearestHeld(const VertexBinding& bound) const {
    std::optional<std::uint32_t> best;
    float most = 0;
    for (int i = 0; i < 3; ++i)
        if (!isLoose(bound.nodes[i]) && (!best || bound.weights[i] > most)) {
            best = bound.nodes[i];
            most = bound.weights[i];
        }
    return best;
}

bool CutSides::separated(std::uint32_t a, std::uint32_t b) {
    return !together(a, b) && joined(aroundBefore_, lattice_.connections, a, b);
}

WholeTriangles::WholeTriangles(const sim::Lattice& lattice, CutSides& sides)
    : lattice_(lattice), sides_(sides), nodes_(controlNodes(lattice)) {}

glm::dvec3 WholeTriangles::normalOf(std::uint32_t triangle) const {
    const glm::uvec3& t = lattice_.boundary[triangle];
    return glm::normalize(triangleNormal(nodes_.rest[t.x], nodes_.rest[t.y], nodes_.rest[t.z]));
}

sim::TriangleTree::Closest WholeTriangles::closest(const glm::dvec3& place, std::uint32_t before,
                                                   std::uint32_t node, bool firm) {
    if (!tree_)
        tree_.emplace(nodes_.rest, nodes_.triangles);
    const glm::dvec3 facing = normalOf(before);
    return tree_->closest(place, kReach, [&](std::uint32_t t) {
        const glm::uvec3& corners = lattice_.boundary[t];
        return sides_.isWhole(corners) && (!firm || sides_.isFirm(corners)) &&
               glm::dot(facing, normalOf(t)) >= kFacing && sides_.together(node, corners.x);
    });
}

void followOwnSides(SurfaceBinding& binding, const sim::Lattice& lattice,
                    const std::vector<glm::dvec3>& positions, CutSides& sides) {
    WholeTriangles triangles(lattice, sides);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        VertexBinding& bound = binding.vertices[v];
        if (!sides.isNear(bound.nodes.x) || sides.isWhole(bound.nodes))
            continue;
        const auto nearest = sides.nearestHeld(bound);
        if (!nearest)
            continue;
        if (const auto closest = triangles.closest(positions[v], binding.triangles[v], *nearest))
            followTriangle(bound, binding.triangles[v], triangles.nodes(), closest.triangle, closest.weights);
    }
}

} // namespace serosa::render
