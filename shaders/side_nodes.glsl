// Nodes beside the blades' cuts: their neighbours, springs and sides (render/side_nodes.h).
#include "shared_constants.h"

layout(std430) restrict readonly buffer b_nodes { uvec4 b_node[]; }; // texel; grid, 10 bits an axis; connections at rest; 0
layout(std430) restrict readonly buffer b_grid { int b_nodeOfGrid[]; };
layout(std430) restrict readonly buffer b_sides { float b_side[]; }; // signed distance to the nearest cut
uniform usampler2D t_nodeInfo;
uniform int u_nodeCount;
uniform ivec3 u_dims; // of the grid
uniform int u_offsets[3 * SRS_NEIGHBOURS];

ivec2 texelOf(int node) {
    uint texel = b_node[node].x;
    return ivec2(texel & 0xffffu, texel >> 16);
}

ivec3 gridOf(int node) {
    uint grid = b_node[node].y;
    return ivec3(grid & 0x3ffu, grid >> 10 & 0x3ffu, grid >> 20);
}

int nodeAt(ivec3 grid) {
    if (any(lessThan(grid, ivec3(0))) || any(greaterThanEqual(grid, u_dims)))
        return -1;
    return b_nodeOfGrid[grid.x + u_dims.x * (grid.y + u_dims.y * grid.z)];
}

ivec3 offset(int direction) {
    return ivec3(u_offsets[3 * direction], u_offsets[3 * direction + 1], u_offsets[3 * direction + 2]);
}

uint connectionsOf(int node) {
    return texelFetch(t_nodeInfo, texelOf(node), 0).x & SRS_CONNECTION_MASK;
}

bool isFar(int node) {
    return abs(b_side[node]) >= SRS_MASK_FAR;
}
