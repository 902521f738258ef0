// See render/cut_surface.h. The mapping of a copy is MS05 3.3.1's, eq. 4 to 7, over another triangle.
#include "render/cut_surface.h"

#include "render/cut_faces.h"
#include "render/cut_sides.h"
#include "shaders/shared_constants.h"
#include "sim/triangle_tree.h"

#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

namespace serosa::render {

namespace {

constexpr int kSearch = 3; // spacings

/// Boundary triangles whose nodes all lie on one side of the cuts near by, by the grid cell of their first
/// node.
class SideTriangles {
public:
    SideTriangles(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections,
                  const std::vector<float>& sides, int side)
        : lattice_(lattice) {
        for (std::uint32_t t = 0; t < lattice.boundary.size(); ++t) {
            bool all = true;
            for (int i = 0; i < 3; ++i) {
                const std::uint32_t node = lattice.boundary[t][i];
                all = all && connections[node] != 0 && std::abs(sides[node]) < float(SRS_MASK_FAR) &&
                      (sides[node] < 0) == (side < 0);
            }
            if (all)
                places_[key(lattice.nodes[lattice.boundary[t].x])].push_back(t);
        }
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

/// Which of a vertex's nodes, and of the corners of its cell, lie on each side of a cut: bit 0 below, bit 1
/// above. Bit 2: one of them lost a connection. \param nodes null: the corners alone
int around(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections,
           const std::vector<float>& sides, const glm::dvec3& place, const glm::uvec3* nodes) {
    int found = 0;
    const auto look = [&](std::int64_t node) {
        if (node < 0)
            return;
        const auto i = std::size_t(node);
        if (connections[i] != lattice.connections[i])
            found |= 4;
        if (std::abs(sides[i]) < float(SRS_MASK_REACH))
            found |= sides[i] < 0 ? 1 : 2;
    };
    for (int i = 0; i < 3 && nodes; ++i)
        look((*nodes)[i]);
    const glm::ivec3 cell = glm::ivec3(glm::floor(place)) + lattice.centre;
    for (int c = 0; c < 8; ++c)
        look(lattice.nodeAt(cell + sim::cornerOffset(c)));
    return found;
}

/// How far a place lies from the nearest cut, by the corners of its cell or else by the nodes that a vertex
/// follows, as CutVertex has it.
double awayOf(const sim::Lattice& lattice, const std::vector<float>& sides, const glm::dvec3& place,
              const VertexBinding& bound) {
    const auto known = [&](std::int64_t node) {
        return node >= 0 && std::abs(sides[std::size_t(node)]) < float(SRS_MASK_FAR);
    };
    const glm::dvec3 low = glm::floor(place), at = place - low;
    double sum = 0, weights = 0;
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 offset = sim::cornerOffset(c);
        const std::int64_t node = lattice.nodeAt(glm::ivec3(low) + lattice.centre + offset);
        const glm::dvec3 w = glm::mix(1.0 - at, at, glm::dvec3(offset));
        if (known(node)) {
            sum += w.x * w.y * w.z * sides[std::size_t(node)];
            weights += w.x * w.y * w.z;
        }
    }
    for (int i = 0; i < 3 && weights < 0.5; ++i)
        if (known(bound.nodes[i])) {
            sum += bound.weights[i] * sides[bound.nodes[i]];
            weights += bound.weights[i];
        }
    return weights > 0.1 ? sum / weights : 0;
}

/// Are all nodes of a vertex on one side of the cuts that are near, and still held?
bool liesOn(const VertexBinding& vertex, const std::vector<std::uint32_t>& connections,
            const std::vector<float>& sides, int side) {
    for (int i = 0; i < 3; ++i) {
        const std::uint32_t node = vertex.nodes[i];
        const bool near = std::abs(sides[node]) < float(SRS_MASK_FAR);
        if (connections[node] == 0 || (near && (sides[node] < 0) != (side < 0)))
            return false;
    }
    return true;
}

/// Which nodes have a place on a side: what shaders/side_nodes.comp does not leave where they are.
class SidePlaces {
public:
    SidePlaces(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections,
               const std::vector<float>& sides)
        : lattice_(lattice), connections_(connections), sides_(sides) {}

    bool hasAll(const glm::uvec3& nodes, int side) const {
        return has(nodes.x, side) && has(nodes.y, side) && has(nodes.z, side);
    }

private:
    bool isFar(std::size_t node) const { return std::abs(sides_[node]) >= float(SRS_MASK_FAR); }
    bool isOn(std::size_t node, int side) const { return !isFar(node) && (sides_[node] >= 0) == (side > 0); }
    /// Had a node springs to the side?
    bool touches(std::size_t node, int side) const {
        for (int d = 0; d < 18; ++d)
            if ((lattice_.connections[node] >> d) & 1U &&
                isOn(std::size_t(lattice_.neighbour(node, d)), side))
                return true;
        return false;
    }
    bool has(std::size_t node, int side) const {
        const bool loose = connections_[node] == 0;
        if (!loose && (isFar(node) || isOn(node, side)))
            return true;
        bool joined = loose || touches(node, side);
        for (int d = 0; d < 6 && !joined; ++d)
            if (const std::int64_t other = lattice_.neighbour(node, d);
                other >= 0 && isOn(std::size_t(other), -side))
                joined = touches(std::size_t(other), side);
        const glm::ivec3 at = lattice_.nodes[node];
        for (int z = -SRS_SIDE_REACH; z <= SRS_SIDE_REACH && joined; ++z)
            for (int y = -SRS_SIDE_REACH; y <= SRS_SIDE_REACH; ++y)
                for (int x = -SRS_SIDE_REACH; x <= SRS_SIDE_REACH; ++x) {
                    const std::int64_t other = lattice_.nodeAt(at + glm::ivec3(x, y, z));
                    if (other >= 0 && connections_[std::size_t(other)] != 0 && isOn(std::size_t(other), side))
                        return true;
                }
        return false;
    }

    const sim::Lattice& lattice_;
    const std::vector<std::uint32_t>& connections_;
    const std::vector<float>& sides_;
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

    const std::array<SideTriangles, 2> triangles = {SideTriangles(lattice, connections, sides, -1),
                                                    SideTriangles(lattice, connections, sides, 1)};
    const std::vector<glm::dvec3> normals = metres.vertexNormals();
    const ControlNodes nodes = controlNodes(lattice);
    const CutSides held(lattice, connections);
    const bool bySides = binding.mapping != sim::Mapping::nodeFrames;
    // In cells, a vertex follows their corners alone, as each side carries them (render/side_nodes.h).
    const bool inCells = binding.mapping == sim::Mapping::trilinear;
    std::vector<int> near(binding.vertices.size());
    for (std::size_t v = 0; v < near.size(); ++v)
        near[v] = around(lattice, connections, sides, lattice.toLattice(metres.positions[v]),
                         inCells ? nullptr : &(bySides ? uncut : binding).vertices[v].nodes);

    const SidePlaces places(lattice, connections, sides);
    std::map<std::pair<std::uint32_t, int>, std::int64_t> copyOf; // -1: that side cannot carry the vertex
    const auto copy = [&](std::uint32_t v, int side) {
        const auto [found, fresh] = copyOf.try_emplace({v, side}, -1);
        if (!fresh)
            return found->second;
        const VertexBinding &own = binding.vertices[v], &before = uncut.vertices[v];
        const auto add = [&](std::optional<VertexBinding> bound) {
            found->second = std::int64_t(surface.vertices.size());
            surface.vertices.push_back(
                {v, side, bound, awayOf(lattice, sides, lattice.toLattice(metres.positions[v]), before)});
            return found->second;
        };
        const bool lies = liesOn(own, connections, sides, side);
        // Beside faces that are drawn whole a vertex stays as it is, unless it belongs to the other side.
        if (inCells || (lies && (!bySides || own.nodes == before.nodes)) ||
            (near[v] != 7 && isHeld(held, own.nodes) && !liesOn(own, connections, sides, -side)))
            return add({});
        const glm::dvec3 place = lattice.toLattice(metres.positions[v]);
        if (bySides && places.hasAll(before.nodes, side))
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
        if (inCells && all != 4) // it tells by its sides whether a cut goes through, not by springs
            surface.whole[f] = true;
        if (all != 7)
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
