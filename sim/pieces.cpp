// See sim/pieces.h. The GPU's twin of the labels is shaders/pieces.frag.
#include "sim/pieces.h"

#include "base/check.h"
#include "sim/cell_volumes.h"

#include <algorithm>
#include <array>
#include <bit>

namespace serosa::sim {

namespace {

/// Index + 1 of the cell at each node of the grid that is its lowest corner; 0 where none.
std::vector<std::uint32_t> cellOfGrid(const Lattice& lattice) {
    std::vector<std::uint32_t> cells(lattice.nodeOfGrid.size(), 0);
    const glm::ivec3 dims = lattice.nodeDims;
    for (std::size_t i = 0; i < lattice.cells.size(); ++i) {
        const glm::ivec3 at = lattice.cells[i].grid;
        cells[(std::size_t(at.z) * std::size_t(dims.y) + std::size_t(at.y)) * std::size_t(dims.x) +
              std::size_t(at.x)] = std::uint32_t(i + 1);
    }
    return cells;
}

} // namespace

std::vector<std::uint32_t> pieceLabels(const Lattice& lattice,
                                       const std::vector<std::uint32_t>& connections) {
    SEROSA_CHECK(connections.size() == lattice.nodeCount(), "one word of connections a node");
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> labels(lattice.nodeCount(), kNone), open;
    for (std::uint32_t seed = 0; seed < labels.size(); ++seed) {
        if (labels[seed] != kNone)
            continue;
        labels[seed] = seed;
        open.push_back(seed);
        while (!open.empty()) {
            const std::uint32_t node = open.back();
            open.pop_back();
            for (std::uint32_t bits = connections[node]; bits != 0; bits &= bits - 1) {
                const auto d = std::size_t(std::countr_zero(bits));
                const auto other = std::uint32_t(lattice.nodeAt(lattice.nodes[node] + kNeighbourOffsets[d]));
                if (labels[other] == kNone) {
                    labels[other] = seed;
                    open.push_back(other);
                }
            }
        }
    }
    return labels;
}

PieceCount countPieces(const std::vector<std::uint32_t>& labels) {
    std::vector<std::uint32_t> size(labels.size(), 0);
    for (const std::uint32_t label : labels)
        ++size[label];
    PieceCount count;
    count.loose = std::size_t(std::count(size.begin(), size.end(), 1u));
    count.pieces = labels.size() - std::size_t(std::count(size.begin(), size.end(), 0u)) - count.loose;
    return count;
}

std::size_t springsCut(const Lattice& lattice, const std::vector<std::uint32_t>& connections) {
    std::size_t ends = 0;
    for (std::size_t node = 0; node < connections.size(); ++node)
        ends += std::size_t(std::popcount(lattice.connections[node] & ~connections[node]));
    return ends / 2;
}

std::vector<bool> wholeCells(const Lattice& lattice, const std::vector<std::uint32_t>& connections) {
    std::vector<bool> whole(lattice.cells.size(), true);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const CellCorners corners = cornersOf(lattice, lattice.cells[i]);
        for (int c = 0; c < 8; ++c) {
            const std::uint32_t needed = directionsInCell(c);
            whole[i] = whole[i] && (connections[corners[std::size_t(c)]] & needed) == needed;
        }
    }
    return whole;
}

std::vector<glm::uvec3> freedFaces(const Lattice& lattice, const std::vector<bool>& whole) {
    SEROSA_CHECK(whole.size() == lattice.cells.size(), "one flag a cell");
    const std::vector<std::uint32_t> cells = cellOfGrid(lattice);
    const glm::ivec3 dims = lattice.nodeDims;
    std::vector<glm::uvec3> faces;
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (int face = 0; whole[i] && face < 6; ++face) {
            const int axis = face / 2, side = face % 2;
            glm::ivec3 next = lattice.cells[i].grid;
            next[axis] += side ? 1 : -1;
            if (next[axis] < 0 || next[axis] >= dims[axis])
                continue;
            const std::uint32_t other =
                cells[(std::size_t(next.z) * std::size_t(dims.y) + std::size_t(next.y)) *
                          std::size_t(dims.x) +
                      std::size_t(next.x)];
            if (other == 0 || whole[other - 1])
                continue;
            // Counter-clockwise from outside: the axes after this one, mirrored on the low side.
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const std::array<glm::ivec2, 4> ring = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
            std::array<std::uint32_t, 4> quad{};
            for (std::size_t k = 0; k < 4; ++k) {
                const glm::ivec2 uv = ring[side ? k : 3 - k];
                glm::ivec3 at = lattice.cells[i].grid;
                at[axis] += side;
                at[u] += uv.x;
                at[v] += uv.y;
                quad[k] = std::uint32_t(lattice.nodeAt(at));
            }
            const auto low = std::size_t(std::min_element(quad.begin(), quad.end()) - quad.begin());
            faces.emplace_back(quad[low], quad[(low + 1) % 4], quad[(low + 2) % 4]);
            faces.emplace_back(quad[low], quad[(low + 2) % 4], quad[(low + 3) % 4]);
        }
    return faces;
}

std::vector<glm::uvec3> boundaryLeft(const Lattice& lattice, const std::vector<std::uint32_t>& connections) {
    const std::vector<bool> whole = wholeCells(lattice, connections);
    if (std::find(whole.begin(), whole.end(), false) == whole.end())
        return lattice.boundary;
    return boundaryOf(lattice, whole);
}

std::vector<glm::uvec3> boundaryOf(const Lattice& lattice, const std::vector<bool>& flags) {
    // The boundary of a lattice of these cells alone: its outer faces are those that are left and those
    // that were freed. Its nodes are found again by their grid coordinates.
    std::vector<LatticeCell> cells;
    glm::ivec3 low = lattice.nodeDims;
    for (std::size_t i = 0; i < flags.size(); ++i)
        if (flags[i]) {
            cells.push_back(lattice.cells[i]);
            low = glm::min(low, lattice.cells[i].grid);
        }
    if (cells.empty())
        return {};
    const Lattice rest = latticeFromCells(cells, lattice.spacing, lattice.origin);
    std::vector<glm::uvec3> faces;
    for (const glm::uvec3& t : rest.boundary)
        faces.emplace_back(lattice.nodeAt(rest.nodes[t.x] + low), lattice.nodeAt(rest.nodes[t.y] + low),
                           lattice.nodeAt(rest.nodes[t.z] + low));
    return faces;
}

} // namespace serosa::sim
