// See render/cut_surface.h.
#include "render/cut_surface.h"

#include "render/cut_faces.h"
#include "render/cut_sides.h"
#include "render/node_sides.h"

#include <map>
#include <utility>

namespace serosa::render {

namespace {

/// Are all nodes of a vertex still held, and no spring between two of them cut?
bool isHeld(const CutSides& cut, const glm::uvec3& nodes) {
    return !cut.isLoose(nodes.x) && !cut.isLoose(nodes.y) && !cut.isLoose(nodes.z) && cut.isWhole(nodes);
}

/// The side, 1 or -1, that NodeSides::parting says; 0: both or none.
int sideOf(int parting) {
    const int sides = parting & (NodeSides::kBelow | NodeSides::kAbove);
    return sides == NodeSides::kAbove ? 1 : sides == NodeSides::kBelow ? -1 : 0;
}

} // namespace

CutSurface cutSurface(const sim::Lattice& lattice, const sim::TriangleMesh& metres,
                      const SurfaceBinding& uncut, const SurfaceBinding& binding,
                      const std::vector<std::uint32_t>& connections, const std::vector<float>& sides) {
    CutSurface surface;
    surface.whole = facesLeft(lattice, metres.faces, binding, connections);
    if (sides.empty())
        return surface;

    const NodeSides known(lattice, connections, sides);
    const CutSides held(lattice, connections);
    std::vector<int> near(binding.vertices.size());
    for (std::size_t v = 0; v < near.size(); ++v) {
        const glm::dvec3 place = lattice.toLattice(metres.positions[v]);
        const glm::uvec3& nodes = binding.vertices[v].nodes;
        near[v] = known.parting(place);
        // Its own nodes are no help where a cut goes through its cell or through them, or lies between.
        const bool own = near[v] != NodeSides::kParted && isHeld(held, nodes) &&
                         (sideOf(near[v]) == 0 || !known.anyOn(nodes, -sideOf(near[v])));
        surface.shares.push_back(own || near[v] == 0 ? known.nearness(place) : 1);
    }

    std::map<std::pair<std::uint32_t, int>, std::uint32_t> copyOf;
    const auto copy = [&](std::uint32_t v, int side) {
        const auto [found, fresh] = copyOf.try_emplace({v, side}, std::uint32_t(surface.vertices.size()));
        if (fresh) // of the other side it is what that has beyond the cut, in cells alone
            surface.vertices.push_back(
                {v, side, sideOf(near[v]) == -side ? 1 : surface.shares[v],
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
    return surface;
}

} // namespace serosa::render
