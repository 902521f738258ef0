// All half-edges sorted by their two vertices put the faces of an edge side by side; joining corners across
// edges with a disjoint-set forest leaves one set for each fan, joining faces one set for each shell.
#include "sim/mesh_topology.h"

#include "base/check.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace serosa::sim {
namespace {

class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// The lowest member stands for the set.
    void join(std::uint32_t i, std::uint32_t j) {
        i = find(i);
        j = find(j);
        parent_[std::max(i, j)] = std::min(i, j);
    }

private:
    std::vector<std::uint32_t> parent_;
};

struct HalfEdge {
    std::uint32_t low, high; // vertices
    std::uint32_t face;
    std::uint8_t corner; // of the face, where the half-edge begins
    bool rising;         // it runs from low to high

    auto key() const { return std::tuple(low, high, face, corner); }
};

bool repeats(const glm::uvec3& t) {
    return t.x == t.y || t.y == t.z || t.z == t.x;
}

std::vector<HalfEdge> sortedHalfEdges(const TriangleMesh& mesh) {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * mesh.faces.size());
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
        const glm::uvec3 t = mesh.faces[face];
        if (repeats(t))
            continue;
        for (std::uint8_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t from = t[corner], to = t[(corner + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), face, corner, from < to});
        }
    }
    std::sort(edges.begin(), edges.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return a.key() < b.key(); });
    return edges;
}

std::vector<std::uint32_t> findDuplicates(const TriangleMesh& mesh) {
    std::vector<std::array<std::uint32_t, 4>> sorted;
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
        std::array<std::uint32_t, 4> entry{mesh.faces[face].x, mesh.faces[face].y, mesh.faces[face].z, face};
        std::sort(entry.begin(), entry.begin() + 3);
        sorted.push_back(entry);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> duplicates;
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (std::equal(sorted[i].begin(), sorted[i].begin() + 3, sorted[i - 1].begin()))
            duplicates.push_back(sorted[i][3]);
    std::sort(duplicates.begin(), duplicates.end());
    return duplicates;
}

} // namespace

bool MeshTopology::closedManifold() const {
    return openEdges.empty() && nonManifoldEdges.empty() && inconsistentEdges.empty() &&
           nonManifoldVertices.empty() &&
           std::find(degenerate.begin(), degenerate.end(), true) == degenerate.end();
}

int MeshTopology::genus(const TriangleMesh& mesh, std::size_t shell) const {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t face : shellFaces[shell])
        for (int corner = 0; corner < 3; ++corner)
            vertices.push_back(mesh.faces[face][corner]);
    std::sort(vertices.begin(), vertices.end());
    const auto count = std::unique(vertices.begin(), vertices.end()) - vertices.begin();
    const auto faces = static_cast<std::ptrdiff_t>(shellFaces[shell].size()); // and 3/2 as many edges
    return static_cast<int>((2 - count + faces / 2) / 2);
}

MeshTopology findTopology(const TriangleMesh& mesh) {
    const std::size_t faces = mesh.faces.size();
    MeshTopology topology;
    topology.degenerate.resize(faces);
    std::vector<bool> used(mesh.positions.size());
    for (std::size_t face = 0; face < faces; ++face) {
        const glm::uvec3 t = mesh.faces[face];
        SEROSA_CHECK(std::max({t.x, t.y, t.z}) < mesh.positions.size(),
                     "a triangle names a vertex that is not there");
        used[t.x] = used[t.y] = used[t.z] = true;
        const glm::dvec3& a = mesh.positions[t.x];
        const glm::dvec3 normal = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
        topology.degenerate[face] = repeats(t) || normal == glm::dvec3(0);
    }
    topology.unusedVertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
    topology.duplicates = findDuplicates(mesh);

    DisjointSets shells(faces), fans(3 * faces);
    const std::vector<HalfEdge> edges = sortedHalfEdges(mesh);
    for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
        for (end = begin + 1; end < edges.size() && edges[end].low == edges[begin].low &&
                              edges[end].high == edges[begin].high;)
            ++end;
        const HalfEdge& first = edges[begin];
        const MeshTopology::Edge edge{first.rising ? first.low : first.high,
                                      first.rising ? first.high : first.low, first.face};
        if (end - begin == 1)
            topology.openEdges.push_back(edge);
        else if (end - begin > 2)
            topology.nonManifoldEdges.push_back(edge);
        else if (first.rising == edges[begin + 1].rising)
            topology.inconsistentEdges.push_back(edge);
        for (std::size_t i = begin + 1; i < end; ++i) {
            const HalfEdge& other = edges[i];
            shells.join(first.face, other.face);
            // The corners at the low vertex belong to one fan, and those at the high vertex.
            const auto cornerAt = [](const HalfEdge& e, bool low) {
                return 3 * e.face + (e.rising == low ? e.corner : (e.corner + 1u) % 3u);
            };
            fans.join(cornerAt(first, true), cornerAt(other, true));
            fans.join(cornerAt(first, false), cornerAt(other, false));
        }
    }

    std::vector<std::uint32_t> fansOf(mesh.positions.size(), 0);
    std::vector<std::uint32_t> shellIndex(faces);
    for (std::uint32_t face = 0; face < faces; ++face) {
        if (repeats(mesh.faces[face]))
            continue;
        for (std::uint32_t corner = 0; corner < 3; ++corner)
            if (fans.find(3 * face + corner) == 3 * face + corner)
                ++fansOf[mesh.faces[face][static_cast<int>(corner)]];
        const std::uint32_t root = shells.find(face); // the lowest face of the shell, seen before
        if (root == face) {
            shellIndex[face] = static_cast<std::uint32_t>(topology.shellFaces.size());
            topology.shellFaces.emplace_back();
        }
        topology.shellFaces[shellIndex[root]].push_back(face);
    }
    for (std::uint32_t vertex = 0; vertex < fansOf.size(); ++vertex)
        if (fansOf[vertex] > 1)
            topology.nonManifoldVertices.push_back(vertex);
    return topology;
}

} // namespace serosa::sim
