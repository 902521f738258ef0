// MS05 3.3. See render/control_nodes.h.
#include "render/control_nodes.h"

#include "base/check.h"
#include "render/triangle_basis.h"
#include "sim/packed_normal.h"

#include <algorithm>
#include <utility>

namespace serosa::render {

ControlNodes controlNodes(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections) {
    SEROSA_CHECK(connections.empty() || connections.size() == lattice.nodeCount(),
                 "connections of all nodes");
    ControlNodes nodes;
    nodes.spacing = lattice.spacing;
    nodes.origin = lattice.origin;
    nodes.triangles = lattice.boundary;
    nodes.neighbourBegin.push_back(0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        nodes.rest.push_back(lattice.restPosition(node));
        const std::uint32_t left = connections.empty() ? lattice.connections[node] : connections[node];
        for (int d = 0; d < int(sim::kNeighbourOffsets.size()); ++d)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0 && (left >> d) & 1U)
                nodes.neighbours.push_back(std::uint32_t(other));
        nodes.neighbourBegin.push_back(std::uint32_t(nodes.neighbours.size()));
    }
    return nodes;
}

ControlNodes controlNodes(const sim::TriangleMesh& metres) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges; // both ways
    for (const glm::uvec3& f : metres.faces)
        for (int i = 0; i < 3; ++i) {
            edges.emplace_back(f[i], f[(i + 1) % 3]);
            edges.emplace_back(f[(i + 1) % 3], f[i]);
        }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    ControlNodes nodes;
    nodes.normalsOfTriangles = true;
    nodes.triangles = metres.faces;
    nodes.origin = 0.5 * (metres.lowest() + metres.highest());
    nodes.neighbourBegin.assign(metres.positions.size() + 1, 0);
    for (const auto& [a, b] : edges) {
        nodes.spacing += glm::distance(metres.positions[a], metres.positions[b]) / double(edges.size());
        nodes.neighbours.push_back(b);
        ++nodes.neighbourBegin[a + 1];
    }
    SEROSA_CHECK(nodes.spacing > 0, "an edge that has a length");
    for (std::size_t i = 0; i < metres.positions.size(); ++i) {
        nodes.neighbourBegin[i + 1] += nodes.neighbourBegin[i];
        nodes.rest.push_back(nodes.toNodes(metres.positions[i]));
    }
    return nodes;
}

sim::Lattice standInLattice(const ControlNodes& nodes) {
    sim::Lattice lattice;
    lattice.spacing = nodes.spacing;
    lattice.origin = nodes.origin;
    lattice.boundary = nodes.triangles;
    lattice.nodeDims = {int(nodes.count()), 1, 1};
    for (std::size_t i = 0; i < nodes.count(); ++i) {
        lattice.nodes.emplace_back(int(i), 0, 0);
        lattice.nodeOfGrid.push_back(std::int32_t(i));
    }
    lattice.connections.resize(nodes.count());
    lattice.fills.resize(nodes.count());
    lattice.depthSteps.resize(nodes.count());
    return lattice;
}

std::vector<glm::dvec3> normalSums(const ControlNodes& nodes, const std::vector<glm::dvec3>& positions) {
    SEROSA_CHECK(positions.size() == nodes.count(), "positions of all nodes");
    std::vector<glm::dvec3> sums(nodes.count(), glm::dvec3(0));
    if (nodes.normalsOfTriangles) {
        for (const glm::uvec3& t : nodes.triangles) {
            const glm::dvec3 n = triangleNormal(positions[t.x], positions[t.y], positions[t.z]);
            for (int i = 0; i < 3; ++i)
                sums[t[i]] += n;
        }
        return sums;
    }
    for (std::size_t node = 0; node < nodes.count(); ++node)
        for (std::uint32_t i = nodes.neighbourBegin[node]; i < nodes.neighbourBegin[node + 1]; ++i)
            sums[node] += glm::normalize(positions[node] - positions[nodes.neighbours[i]]);
    return sums;
}

std::vector<std::uint32_t> packedNormals(const ControlNodes& nodes,
                                         const std::vector<glm::dvec3>& positions) {
    std::vector<std::uint32_t> packed;
    for (const glm::dvec3& sum : normalSums(nodes, positions))
        packed.push_back(sim::packNormal(glm::vec3(sum)));
    return packed;
}

} // namespace serosa::render
