// The lattice's cells as the passes of the rest-space mask know them (render/cut_mask.h).
#include "cut_mask_position.glsl"
#include "shared_constants.h"

struct MaskCell {
    uint grid;      // x, y, z: 10 bits each
    uint open;      // bit x + 3 y + 9 z: the neighbour at (x, y, z) - 1 is no cell of the organ
    uint texels[8]; // of its corners' nodes: y << 16 | x
    uint nodes[8];  // their indices
};

layout(std430) readonly restrict buffer b_cells { MaskCell cells[]; };

ivec3 cellGrid(uint grid) {
    return ivec3(grid & 0x3ffu, grid >> 10 & 0x3ffu, grid >> 20);
}
