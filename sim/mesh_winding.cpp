// See sim/mesh_winding.h. A surface winds alike where each edge is run in both directions, once each.
#include "sim/mesh_winding.h"

#include "base/check.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace serosa::sim {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

std::uint64_t halfEdge(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t(from) << 32 | to;
}

/// For each face and corner the face across the edge that begins there, and whether it winds alike.
struct Neighbour {
    std::uint32_t face = kNone;
    bool alike = true;
};

std::vector<Neighbour> neighboursOf(const TriangleMesh& mesh) {
    std::vector<Neighbour> neighbours(3 * mesh.faces.size());
    std::unordered_map<std::uint64_t, std::uint32_t> first; // half-edge number of each undirected edge
    first.reserve(2 * mesh.faces.size());
    for (std::uint32_t half = 0; half < neighbours.size(); ++half) {
        const glm::uvec3& t = mesh.faces[half / 3];
        const std::uint32_t from = t[int(half % 3)], to = t[int((half + 1) % 3)];
        const auto [entry, isNew] = first.try_emplace(halfEdge(std::min(from, to), std::max(from, to)), half);
        if (isNew)
            continue;
        const std::uint32_t other = entry->second;
        SEROSA_CHECK(neighbours[other].face == kNone, "an edge has more than two faces");
        const bool alike = mesh.faces[other / 3][int(other % 3)] == to;
        neighbours[half] = {other / 3, alike};
        neighbours[other] = {half / 3, alike};
    }
    return neighbours;
}

/// Hole edges, opposite to the faces' edges that have no partner, and the way around a vertex.
class HoleEdges {
public:
    explicit HoleEdges(const TriangleMesh& mesh) : mesh_(mesh) {
        for (std::uint32_t half = 0; half < 3 * mesh.faces.size(); ++half)
            halves_[halfEdge(from(half), from(next(half)))] = half;
        for (std::uint32_t half = 0; half < 3 * mesh.faces.size(); ++half)
            if (!halves_.contains(halfEdge(from(next(half)), from(half))))
                leaving_[from(next(half))].push_back(from(half));
    }

    /// Vertices that a hole edge leaves, ascending.
    std::vector<std::uint32_t> vertices() const {
        std::vector<std::uint32_t> all;
        for (const auto& entry : leaving_)
            all.push_back(entry.first);
        std::sort(all.begin(), all.end());
        return all;
    }
    const std::vector<std::uint32_t>& leaving(std::uint32_t vertex) const { return leaving_.at(vertex); }

    /// Where the hole that comes from `before` to `vertex` goes on to; kNone if more than two holes meet.
    std::uint32_t after(std::uint32_t before, std::uint32_t vertex) const {
        const auto& ways = leaving_.at(vertex);
        if (ways.size() == 1)
            return ways[0];
        if (ways.size() > 2)
            return kNone;
        // Around the fan that the edge belongs to, to its other end: the hole goes on at the other fan.
        std::uint32_t half = halves_.at(halfEdge(vertex, before));
        std::uint32_t end = from(next(next(half)));
        for (auto at = halves_.find(halfEdge(vertex, end)); at != halves_.end();
             at = halves_.find(halfEdge(vertex, end)))
            end = from(next(next(at->second)));
        return ways[0] == end ? ways[1] : ways[0];
    }

private:
    static std::uint32_t next(std::uint32_t half) { return half % 3 == 2 ? half - 2 : half + 1; }
    std::uint32_t from(std::uint32_t half) const { return mesh_.faces[half / 3][int(half % 3)]; }

    const TriangleMesh& mesh_;
    std::unordered_map<std::uint64_t, std::uint32_t> halves_;
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> leaving_;
};

} // namespace

std::optional<std::vector<bool>> facesToFlip(const TriangleMesh& mesh) {
    const std::vector<Neighbour> neighbours = neighboursOf(mesh);
    std::vector<bool> flip(mesh.faces.size(), false), seen(mesh.faces.size(), false);
    for (std::uint32_t seed = 0; seed < mesh.faces.size(); ++seed) {
        if (seen[seed])
            continue;
        std::vector<std::uint32_t> part{seed};
        seen[seed] = true;
        std::size_t flipped = 0;
        for (std::size_t i = 0; i < part.size(); ++i)
            for (std::uint32_t corner = 0; corner < 3; ++corner) {
                const Neighbour& neighbour = neighbours[3 * part[i] + corner];
                if (neighbour.face == kNone)
                    continue;
                const bool wanted = neighbour.alike == flip[part[i]];
                if (!seen[neighbour.face]) {
                    seen[neighbour.face] = true;
                    flip[neighbour.face] = wanted;
                    flipped += wanted;
                    part.push_back(neighbour.face);
                } else if (flip[neighbour.face] != wanted) {
                    return {};
                }
            }
        if (2 * flipped > part.size())
            for (const std::uint32_t face : part)
                flip[face] = !flip[face];
    }
    return flip;
}

Result<std::vector<BoundaryLoop>> boundaryLoops(const TriangleMesh& mesh, const std::string& name) {
    const HoleEdges holes(mesh);
    std::vector<BoundaryLoop> loops;
    std::unordered_set<std::uint64_t> walked;
    for (const std::uint32_t start : holes.vertices())
        for (const std::uint32_t second : holes.leaving(start)) {
            if (walked.contains(halfEdge(start, second)))
                continue;
            BoundaryLoop loop;
            std::unordered_set<std::uint32_t> visited;
            std::uint32_t from = start, to = second;
            while (walked.insert(halfEdge(from, to)).second) {
                if (!visited.insert(from).second)
                    return Error{name + ": a hole passes vertex " + std::to_string(from) +
                                 " (from 0) twice; separate the parts that meet there"};
                loop.push_back(from);
                const std::uint32_t next = holes.after(from, to);
                if (next == kNone)
                    return Error{name + ": more than two holes meet in vertex " + std::to_string(to) +
                                 " (from 0); fill them in a mesh editor"};
                from = to;
                to = next;
            }
            loops.push_back(std::move(loop));
        }
    return loops;
}

} // namespace serosa::sim
