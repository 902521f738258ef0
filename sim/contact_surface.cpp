// See sim/contact_surface.h.
#include "sim/contact_surface.h"

#include "sim/pieces.h"

#include <algorithm>
#include <numeric>

namespace serosa::sim {

namespace {

constexpr int kSide = 4; // of a block at rest, spacings

/// Items in the order of their blocks, by their lowest grid coordinate; in a block as they were.
struct Sorted {
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> key; // of each of `order`
};

Sorted sortByBlock(const Lattice& lattice, const std::vector<glm::ivec3>& grids) {
    const glm::ivec3 dims = (lattice.nodeDims + kSide - 1) / kSide;
    std::vector<std::uint32_t> keys;
    for (const glm::ivec3& grid : grids) {
        const glm::ivec3 block = grid / kSide;
        keys.push_back(std::uint32_t((block.z * dims.y + block.y) * dims.x + block.x));
    }
    Sorted sorted;
    sorted.order.resize(grids.size());
    std::iota(sorted.order.begin(), sorted.order.end(), 0u);
    std::stable_sort(sorted.order.begin(), sorted.order.end(),
                     [&keys](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    for (const std::uint32_t item : sorted.order)
        sorted.key.push_back(keys[item]);
    return sorted;
}

/// \param addNodes appends those of item number i of the order
template <class AddNodes>
ContactBlocks cutBlocks(const Sorted& sorted, const AddNodes& addNodes) {
    ContactBlocks cut;
    for (std::size_t i = 0; i < sorted.order.size(); ++i) {
        if (i == 0 || sorted.key[i] != sorted.key[i - 1])
            cut.blocks.push_back({std::uint32_t(i), 0, std::uint32_t(cut.nodes.size()), 0});
        ++cut.blocks.back().count;
        addNodes(i, cut.nodes);
        if (i + 1 < sorted.order.size() && sorted.key[i + 1] == sorted.key[i])
            continue;
        const auto begin = cut.nodes.begin() + cut.blocks.back().firstNode;
        std::sort(begin, cut.nodes.end());
        cut.nodes.erase(std::unique(begin, cut.nodes.end()), cut.nodes.end());
        cut.blocks.back().nodes = std::uint32_t(cut.nodes.size()) - cut.blocks.back().firstNode;
    }
    return cut;
}

} // namespace

ContactSurface contactSurface(const Lattice& lattice, const std::vector<std::uint32_t>& connections) {
    ContactSurface surface;
    const Sorted nodes = sortByBlock(lattice, lattice.nodes);
    surface.nodes = cutBlocks(
        nodes, [&](std::size_t i, std::vector<std::uint32_t>& to) { to.push_back(nodes.order[i]); });

    const std::vector<glm::uvec3> triangles = boundaryLeft(lattice, connections);
    std::vector<glm::ivec3> lowest;
    for (const glm::uvec3& t : triangles)
        lowest.push_back(glm::min(lattice.nodes[t.x], glm::min(lattice.nodes[t.y], lattice.nodes[t.z])));
    const Sorted sorted = sortByBlock(lattice, lowest);
    for (const std::uint32_t triangle : sorted.order)
        surface.triangles.push_back(triangles[triangle]);
    surface.triangleBlocks = cutBlocks(sorted, [&](std::size_t i, std::vector<std::uint32_t>& to) {
        const glm::uvec3& t = surface.triangles[i];
        to.insert(to.end(), {t.x, t.y, t.z});
    });
    return surface;
}

} // namespace serosa::sim
