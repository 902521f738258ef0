// Grid strips and compact rows. In rows, one pad texel stands in each gap of exactly one node, so that the
// neighbours x-1, x, x+1 of a node in another row lie at consecutive texels around one offset, whichever of
// them exist.
#include "sim/texture_layout.h"

#include "shaders/shared_constants.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cstdint>
#include <string>

namespace serosa::sim {

namespace {

constexpr std::array<glm::ivec2, 8> kRowNeighbours = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}}; // (dy, dz)

Error tooLarge(const Lattice& lattice, int width, int height, int maxSize) {
    return Error{"a lattice of " + std::to_string(lattice.nodeCount()) + " nodes needs textures of " +
                 std::to_string(width) + " x " + std::to_string(height) +
                 " texels, this context has at most " + std::to_string(maxSize) +
                 " along a side: take fewer nodes or a larger spacing"};
}

TextureLayout gridLayout(const Lattice& lattice) {
    TextureLayout layout;
    layout.kind = SRS_LAYOUT_GRID;
    layout.width = lattice.nodeDims.x;
    layout.height = lattice.nodeDims.y * lattice.nodeDims.z;
    layout.gridStride = {1, 1, lattice.nodeDims.y};
    layout.texelOfNode.reserve(lattice.nodeCount());
    for (const glm::ivec3& node : lattice.nodes)
        layout.texelOfNode.emplace_back(node.x, node.y + lattice.nodeDims.y * node.z);
    return layout;
}

TextureLayout rowsLayout(const Lattice& lattice) {
    TextureLayout layout;
    layout.kind = SRS_LAYOUT_ROWS;
    std::vector<std::int32_t> linear(lattice.nodeCount());
    std::int32_t next = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        if (node > 0) {
            const glm::ivec3 step = lattice.nodes[node] - lattice.nodes[node - 1];
            if (step.z == 0 && step.y == 0 && step.x == 2)
                ++next; // the pad texel
        }
        linear[node] = next++;
    }
    const int texels = std::max(next, 1);
    layout.width = 1;
    while (layout.width * layout.width < texels)
        layout.width *= 2;
    layout.height = (texels + layout.width - 1) / layout.width;
    layout.rowOffsets.assign(layout.texels() * 8, 0);
    layout.texelOfNode.reserve(lattice.nodeCount());
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        layout.texelOfNode.emplace_back(linear[node] % layout.width, linear[node] / layout.width);
        for (std::size_t row = 0; row < 8; ++row)
            for (const int dx : {0, -1, 1}) {
                const glm::ivec3 there =
                    lattice.nodes[node] + glm::ivec3(dx, kRowNeighbours[row].x, kRowNeighbours[row].y);
                const std::int64_t other = lattice.nodeAt(there);
                if (other < 0)
                    continue;
                layout.rowOffsets[std::size_t(linear[node]) * 8 + row] =
                    linear[std::size_t(other)] - dx - linear[node];
                break;
            }
    }
    return layout;
}

} // namespace

Result<TextureLayout> makeTextureLayout(const Lattice& lattice, int kind, int maxSize) {
    if (kind < 0) {
        const double gridTexels = double(lattice.nodeDims.x) * lattice.nodeDims.y * lattice.nodeDims.z;
        const bool gridFits = std::int64_t(lattice.nodeDims.y) * lattice.nodeDims.z <= maxSize;
        kind = gridFits && double(lattice.nodeCount()) > 0.4 * gridTexels ? SRS_LAYOUT_GRID : SRS_LAYOUT_ROWS;
    }
    const std::int64_t stripHeight = std::int64_t(lattice.nodeDims.y) * lattice.nodeDims.z;
    if (kind == SRS_LAYOUT_GRID && (stripHeight > maxSize || lattice.nodeDims.x > maxSize))
        return tooLarge(lattice, lattice.nodeDims.x, int(std::min<std::int64_t>(stripHeight, INT32_MAX)),
                        maxSize);
    TextureLayout layout = kind == SRS_LAYOUT_GRID ? gridLayout(lattice) : rowsLayout(lattice);
    if (layout.width > maxSize || layout.height > maxSize)
        return tooLarge(lattice, layout.width, layout.height, maxSize);
    return layout;
}

} // namespace serosa::sim
