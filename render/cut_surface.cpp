// See render/cut_surface.h.
#include "render/cut_surface.h"

#include "render/cut_faces.h"
#include "render/cut_sides.h"
#include "render/node_sides.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace serosa::render {

namespace {

/// The side, 1 or -1, that NodeSides::parting says; 0: both or none.
int sideOf(int parting) {
    const int sides = parting & (NodeSides::kBelow | NodeSides::kAbove);
    return sides == NodeSides::kAbove ? 1 : sides == NodeSides::kBelow ? -1 : 0;
}

void copyAlongCuts(CutSurface& surface, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                   const SurfaceBinding& uncut, const SurfaceBinding& binding,
                   const std::vector<std::uint32_t>& connections, const std::vector<float>& sides,
                   const CutSides& held) {
    const NodeSides known(lattice, connections, sides);
    std::vector<int> near(binding.vertices.size());
    for (std::size_t v = 0; v < near.size(); ++v) {
        const glm::dvec3 place = lattice.toLattice(metres.positions[v]);
        const glm::uvec3& nodes = binding.vertices[v].nodes;
        near[v] = known.parting(place);
        // Its own nodes are no help where a cut goes through its cell or through them, or lies between.
        const bool own = near[v] != NodeSides::kParted && held.isHeld(nodes) &&
                         (sideOf(near[v]) == 0 || !known.anyOn(nodes, -sideOf(near[v])));
        surface.shares.push_back(own || near[v] == 0 ? known.nearness(place) : 1);
    }

    std::map<std::pair<std::uint32_t, int>, std::uint32_t> copyOf;
    const auto copy = [&](std::uint32_t v, int side) {
        const auto [found, fresh] = copyOf.try_emplace({v, side}, std::uint32_t(surface.vertices.size()));
        if (fresh) // of the other side it is what that has beyond the cut, in cells alone
            surface.vertices.push_back(
                {v,
                 side,
                 {},
                 sideOf(near[v]) == -side ? 1 : surface.shares[v],
                 known.away(lattice.toLattice(metres.positions[v]), uncut.vertices[v])});
        return found->second;
    };
    for (std::size_t f = 0; f < metres.faces.size(); ++f) {
        const glm::uvec3& face = metres.faces[f];
        const int all = near[face.x] | near[face.y] | near[face.z];
        if (all != NodeSides::kLost) // a blade's cut, if any: its sides tell where it goes through
            surface.whole[f] = all != NodeSides::kParted;
        if (all != NodeSides::kParted)
            continue;
        for (const int side : {-1, 1}) {
            surface.copies.emplace_back(copy(face.x, side), copy(face.y, side), copy(face.z, side));
            surface.copied.push_back(std::uint32_t(f));
        }
    }
}

void copyAlongTears(CutSurface& surface, const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                    const SurfaceBinding& binding, CutSides& held) {
    std::vector<bool> copied(surface.whole.size());
    for (const std::uint32_t f : surface.copied)
        copied[f] = true;
    WholeTriangles triangles(lattice, held);
    std::map<std::pair<std::uint32_t, std::int64_t>, std::uint32_t> copyOf; // by triangle; -1: its own
    std::map<std::pair<std::uint32_t, std::uint32_t>, sim::TriangleTree::Closest> found; // by node
    /// The copy of a vertex that goes with a node; none: it cannot.
    const auto copy = [&](std::uint32_t v, std::uint32_t node) -> std::optional<std::uint32_t> {
        const VertexBinding& own = binding.vertices[v];
        const auto nearest = held.nearestHeld(own);
        CutVertex vertex{v, 0, {}, 0, 0};
        std::int64_t triangle = -1;
        if (!nearest || !held.isHeld(own.nodes) || !held.isFirm(own.nodes) ||
            !held.together(*nearest, node)) {
            const auto [at, fresh] = found.try_emplace({v, node});
            if (fresh)
                at->second = triangles.closest(lattice.toLattice(metres.positions[v]), binding.triangles[v],
                                               node, true);
            if (!at->second)
                return {};
            triangle = at->second.triangle;
            vertex.follows = FollowedTriangle{at->second.triangle, at->second.weights};
        }
        const auto [at, fresh] = copyOf.try_emplace({v, triangle}, std::uint32_t(surface.vertices.size()));
        if (fresh)
            surface.vertices.push_back(vertex);
        return at->second;
    };
    for (std::size_t f = 0; f < metres.faces.size(); ++f) {
        if (surface.whole[f] || copied[f])
            continue;
        const glm::uvec3& face = metres.faces[f];
        std::vector<std::uint32_t> groups; // a node of each side
        for (int i = 0; i < 3; ++i)
            if (const auto node = held.nearestHeld(binding.vertices[face[i]]))
                if (std::none_of(groups.begin(), groups.end(),
                                 [&](std::uint32_t other) { return held.together(*node, other); }))
                    groups.push_back(*node);
        for (const std::uint32_t node : groups) {
            const auto a = copy(face.x, node), b = copy(face.y, node), c = copy(face.z, node);
            if (!a || !b || !c)
                continue;
            surface.copies.emplace_back(*a, *b, *c);
            surface.copied.push_back(std::uint32_t(f));
        }
    }
}

} // namespace

CutSurface cutSurface(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                      const SurfaceBinding& uncut, const SurfaceBinding& binding,
                      const std::vector<std::uint32_t>& connections, const std::vector<float>& sides) {
    CutSurface surface;
    surface.whole = facesLeft(lattice, metres.faces, binding, connections);
    CutSides held(lattice, connections);
    if (!sides.empty())
        copyAlongCuts(surface, lattice, metres, uncut, binding, connections, sides, held);
    if (binding.mapping != sim::Mapping::trilinear)
        copyAlongTears(surface, lattice, metres, binding, held);
    return surface;
}

} // namespace serosa::render
