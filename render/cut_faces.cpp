// See render/cut_faces.h.
#include "render/cut_faces.h"

#include "sim/pieces.h"

#include <algorithm>
#include <array>

namespace serosa::render {

namespace {

/// Were two nodes joined before anything was cut, and are they no longer?
bool parted(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections, std::uint32_t a,
            std::uint32_t b) {
    const glm::ivec3 offset = lattice.nodes[b] - lattice.nodes[a];
    for (std::size_t d = 0; d < sim::kNeighbourOffsets.size(); ++d)
        if (sim::kNeighbourOffsets[d] == offset)
            return ((lattice.connections[a] & ~connections[a]) >> d) & 1U;
    return false;
}

} // namespace

std::vector<bool> facesLeft(const sim::Lattice& lattice, const std::vector<glm::uvec3>& faces,
                            const SurfaceBinding& binding, const std::vector<std::uint32_t>& connections) {
    const std::vector<std::uint32_t> labels = sim::pieceLabels(lattice, connections);
    std::vector<bool> left(faces.size(), true);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        std::array<std::uint32_t, 9> nodes{};
        bool touched = false;
        for (int i = 0; i < 9; ++i) {
            const std::uint32_t node = binding.vertices[faces[f][i / 3]].nodes[i % 3];
            nodes[std::size_t(i)] = node;
            touched = touched || connections[node] != lattice.connections[node];
        }
        for (std::size_t i = 0; i < 9 && left[f]; ++i)
            for (std::size_t j = 0; j < i && left[f]; ++j)
                left[f] =
                    labels[nodes[i]] == labels[nodes[j]] &&
                    !(touched && nodes[i] != nodes[j] && parted(lattice, connections, nodes[i], nodes[j]));
    }
    return left;
}

std::vector<glm::uvec3> boundaryLeft(const sim::Lattice& lattice,
                                     const std::vector<std::uint32_t>& connections) {
    const std::vector<bool> whole = sim::wholeCells(lattice, connections);
    if (std::find(whole.begin(), whole.end(), false) == whole.end())
        return lattice.boundary;
    // The boundary of a lattice of the whole cells alone: its outer faces are those that are left and those
    // that were freed. Its nodes are found again by their grid coordinates.
    std::vector<sim::LatticeCell> cells;
    glm::ivec3 low = lattice.nodeDims;
    for (std::size_t i = 0; i < whole.size(); ++i)
        if (whole[i]) {
            cells.push_back(lattice.cells[i]);
            low = glm::min(low, lattice.cells[i].grid);
        }
    if (cells.empty())
        return {};
    const sim::Lattice rest = sim::latticeFromCells(cells, lattice.spacing, lattice.origin);
    std::vector<glm::uvec3> faces;
    for (const glm::uvec3& t : rest.boundary)
        faces.emplace_back(lattice.nodeAt(rest.nodes[t.x] + low), lattice.nodeAt(rest.nodes[t.y] + low),
                           lattice.nodeAt(rest.nodes[t.z] + low));
    return faces;
}

} // namespace serosa::render
