#pragma once
// Where each node of a lattice lies in the arrays of the CPU solver. Nodes of one grid row (equal y, z) lie
// side by side along x, so that a vector of nodes finds its neighbours in eight other rows, each at one
// constant offset, by plain loads: no gathers, no index lists. A row is cut where more nodes are missing than
// a vector holds; smaller gaps and row ends are filled with pads, which have no springs and never move.

#include "sim/lattice.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace serosa::sim {

/// (dy, dz) of the eight row neighbours.
inline constexpr std::array<glm::ivec2, 8> kCpuRows = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};

struct CpuLayout {
    std::size_t lanes = 0; // slots a block: a vector's
    std::size_t first = 0; // slot of the first block; as many slots stand behind the last one, so
                           // that the loads around any block stay inside of the arrays
    std::vector<std::int32_t> slotOfNode; // one a node
    /// One a block: the slot beside the block's first one (equal x) in row kCpuRows[i], minus its own. A lane
    /// whose neighbour is not there reads some other slot, under a weight of 0.
    std::vector<std::array<std::int32_t, 8>> rows;

    std::size_t blocks() const { return rows.size(); }
    /// Length of every array that holds one value a slot.
    std::size_t slots() const { return 2 * first + blocks() * lanes; }
};

/// \param lanes at least 1.
CpuLayout makeCpuLayout(const Lattice& lattice, std::size_t lanes);

} // namespace serosa::sim
