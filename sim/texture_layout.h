#pragma once
// Where each node's texel lies in the 2D state textures (ARCHITECTURE.md, texture formats).
//  grid: strips, width nx, height ny*nz; neighbour offsets are constant; best when the grid is well filled.
//  rows: only nodes, row after row (x fastest); a neighbour is found by one of eight row offsets, see
//  rowOffsets.
// A heart fills a fifth of its box: rows is the default below 40% filled.

#include "base/result.h"
#include "sim/lattice.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace serosa::sim {

struct TextureLayout {
    int kind = 0;              // SRS_LAYOUT_GRID or SRS_LAYOUT_ROWS
    int width = 0, height = 0; // texels
    glm::ivec3 gridStride{0};  // grid: texel offset of +x, +y, +z is (x, y + ny z); stores (1, 1, ny)
    std::vector<glm::uvec2> texelOfNode; // one a node

    /// rows: for the row neighbours (dy, dz) in the order (+,0) (-,0) (0,+) (0,-) (+,+) (-,-) (+,-) (-,+),
    /// the linear texel index of the node beside it (same x) minus the node's own; eight a texel of the
    /// texture.
    std::vector<std::int32_t> rowOffsets;

    std::size_t texels() const { return std::size_t(width) * std::size_t(height); }
};

/// \param kind SRS_LAYOUT_..., or -1 to choose. \param maxSize the context's GL_MAX_TEXTURE_SIZE.
/// Errors: needs more than maxSize texels along a side.
Result<TextureLayout> makeTextureLayout(const Lattice& lattice, int kind, int maxSize);

} // namespace serosa::sim
