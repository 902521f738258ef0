#pragma once
// What of an organ touches other things, in blocks that lie together at rest, so that what is far from all
// tools is passed over a block at a time: its nodes, and the triangles that close it (sim/pieces.h).

#include "sim/lattice.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

struct ContactBlock {
    std::uint32_t first = 0, count = 0;     // of the items: nodes, or triangles
    std::uint32_t firstNode = 0, nodes = 0; // of ContactBlocks::nodes: those that bound it, each once
};

struct ContactBlocks {
    std::vector<ContactBlock> blocks;
    std::vector<std::uint32_t> nodes;
};

struct ContactSurface {
    /// All nodes (where a tool begins inside, those in there are pushed out of it), block by block.
    ContactBlocks nodes;
    /// Block by block; block `first` indexes this.
    std::vector<glm::uvec3> triangles;
    ContactBlocks triangleBlocks;
};

/// \param connections 18 bits a node
ContactSurface contactSurface(const Lattice& lattice, const std::vector<std::uint32_t>& connections);

} // namespace serosa::sim
