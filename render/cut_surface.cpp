// See render/cut_surface.h. The mapping of a copy is MS05 3.3.1's, eq. 4 to 7, over another triangle.
#include "render/cut_surface.h"

#include "render/cut_faces.h"
#include "render/cut_sides.h"
#include "render/node_sides.h"
#include "sim/triangle_tree.h"

#include <array>
#include <map>
#include <unordered_map>

namespace serosa::render {

namespace {

constexpr int kSearch = 3; // spacings

/// Boundary triangles whose nodes all lie on one side of the cuts near by, by the grid cell of their first
/// node.
class SideTriangles {
public:
    SideTriangles(const sim::Lattice& lattice, const NodeSides& sides, int side) : lattice_(lattice) {
        for (std::uint32_t t = 0; t < lattice.boundary.size(); ++t)
            if (sides.areOn(lattice.boundary[t], side))
                places_[key(lattice.nodes[lattice.boundary[t].x])].push_back(t);
    }

    /// The closest to a place (lattice units) that does not face away from `normal`; -1: none near.
    std::int64_t closest(const glm::dvec3& place, const glm::dvec3& normal, glm::dvec3& weights) const {
        const glm::ivec3 at = glm::ivec3(glm::floor(place)) + lattice_.centre;
        double least = kSearch;
        std::int64_t found = -1;
        for (int z = -kSearch; z <= kSearch; ++z)
            for (int y = -kSearch; y <= kSearch; ++y)
                for (int x = -kSearch; x <= kSearch; ++x) {
                    const auto bucket = places_.find(key(at + glm::ivec3(x, y, z)));
                    if (bucket == places_.end())
                        continue;
                    for (const std::uint32_t t : bucket->second) {
                        const auto p = corners(t);
                        const sim::TrianglePoint nearest =
                            sim::closestPointOnTriangle(place, p[0], p[1], p[2]);
                        const double facing =
                            glm::dot(glm::normalize(triangleNormal(p[0], p[1], p[2])), normal);
                        const double cost = glm::distance(nearest.point, place) + (facing < -0.2 ? 1.0 : 0.0);
                        if (cost < least) {
                            least = cost;
                            found = t;
                            weights = nearest.weights;
                        }
                    }
                }
        return found;
    }

private:
    static std::uint64_t key(const glm::ivec3& at) {
        return std::uint64_t(std::uint32_t(at.x + 64)) << 42 ^ std::uint64_t(std::uint32_t(at.y + 64)) << 21 ^
               std::uint64_t(std::uint32_t(at.z + 64));
    }
    std::array<glm::dvec3, 3> corners(std::uint32_t t) const {
        const glm::uvec3& nodes = lattice_.boundary[t];
        return {lattice_.restPosition(nodes.x), lattice_.restPosition(nodes.y),
                lattice_.restPosition(nodes.z)};
    }

    const sim::Lattice& lattice_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> places_;
};

/// Are all nodes of a vertex still held, and no spring between two of them cut?
bool isHeld(const CutSides& cut, const glm::uvec3& nodes) {
    return !cut.isLoose(nodes.x) && !cut.isLoose(nodes.y) && !cut.isLoose(nodes.z) && cut.isWhole(nodes);
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
    const std::array<SideTriangles, 2> triangles = {SideTriangles(lattice, known, -1),
                                                    SideTriangles(lattice, known, 1)};
    const std::vector<glm::dvec3> normals = metres.vertexNormals();
    const ControlNodes nodes = controlNodes(lattice);
    const CutSides held(lattice, connections);
    const bool bySides = binding.mapping != sim::Mapping::nodeFrames;
    // In cells, a vertex follows their corners alone, as each side carries them (render/side_nodes.h).
    const bool inCells = binding.mapping == sim::Mapping::trilinear;
    std::vector<int> near(binding.vertices.size());
    for (std::size_t v = 0; v < near.size(); ++v)
        near[v] = known.parting(lattice.toLattice(metres.positions[v]),
                                inCells ? nullptr : &(bySides ? uncut : binding).vertices[v].nodes);

    std::map<std::pair<std::uint32_t, int>, std::int64_t> copyOf; // -1: that side cannot carry the vertex
    const auto copy = [&](std::uint32_t v, int side) {
        const auto [found, fresh] = copyOf.try_emplace({v, side}, -1);
        if (!fresh)
            return found->second;
        const VertexBinding &own = binding.vertices[v], &before = uncut.vertices[v];
        const auto add = [&](std::optional<VertexBinding> bound) {
            found->second = std::int64_t(surface.vertices.size());
            surface.vertices.push_back(
                {v, side, bound, known.away(lattice.toLattice(metres.positions[v]), before)});
            return found->second;
        };
        const bool lies = known.goWith(own.nodes, side);
        // Beside faces that are drawn whole a vertex stays as it is, unless it belongs to the other side.
        if (inCells || (lies && (!bySides || own.nodes == before.nodes)) ||
            (near[v] != NodeSides::kParted && isHeld(held, own.nodes) && !known.goWith(own.nodes, -side)))
            return add({});
        const glm::dvec3 place = lattice.toLattice(metres.positions[v]);
        if (bySides && known.havePlaces(before.nodes, side))
            return add(bindVertex(nodes, before.nodes, glm::dvec3(before.weights), place, normals[v]));
        if (lies)
            return add({});
        glm::dvec3 weights(0);
        const std::int64_t t = triangles[side > 0].closest(place, normals[v], weights);
        if (t >= 0)
            return add(bindVertex(nodes, lattice.boundary[std::size_t(t)], weights, place, normals[v]));
        return found->second;
    };
    for (std::size_t f = 0; f < metres.faces.size(); ++f) {
        const glm::uvec3& face = metres.faces[f];
        const int all = near[face.x] | near[face.y] | near[face.z];
        if (inCells &&
            all != NodeSides::kLost) // it tells by its sides whether a cut goes through, not by springs
            surface.whole[f] = true;
        if (all != NodeSides::kParted)
            continue;
        surface.whole[f] = false;
        for (const int side : {-1, 1}) {
            const std::int64_t a = copy(face.x, side), b = copy(face.y, side), c = copy(face.z, side);
            if (a < 0 || b < 0 || c < 0)
                continue;
            surface.copies.emplace_back(a, b, c);
            surface.copied.push_back(std::uint32_t(f));
        }
    }
    return surface;
}

} // namespace serosa::render
