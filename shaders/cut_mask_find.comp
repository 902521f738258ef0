#version 450 core
// Lists the cells that a stroke comes near, as they lie now: those that cut_mask_paint.comp goes through.
#include "cut_mask_cells.glsl"

layout(local_size_x = 64) in;

layout(std430) restrict buffer b_list {
    uint groups[4]; // x: one a listed cell, 65535 at most; y, z: 1; w: cells listed
    uint listed[];
};

uniform int u_cellCount;
uniform vec3 u_lowest, u_highest; // of what the stroke sweeps, with the mask's reach around it

void main() {
    uint cell = gl_GlobalInvocationID.x;
    if (cell >= uint(u_cellCount))
        return;
    vec3 low = nodePosition(cells[cell].texels[0]), high = low;
    for (int c = 1; c < 8; ++c) {
        vec3 at = nodePosition(cells[cell].texels[c]);
        low = min(low, at);
        high = max(high, at);
    }
    if (any(greaterThan(low, u_highest)) || any(lessThan(high, u_lowest)))
        return;
    uint place = atomicAdd(groups[3], 1u);
    listed[place] = cell;
    atomicMax(groups[0], min(place + 1u, 65535u));
}
