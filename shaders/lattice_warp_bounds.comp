// First passes of render/lattice_warp.h: bounds of the nodes; WARP_CUT: of those of a side; WARP_WAYS: how far they go in a step;
// WARP_FRAME: the voxels' box.
#version 450 core
#include "lattice_warp_box.glsl"
#include "raycast_constants.h"
#ifdef WARP_FRAME
layout(local_size_x = 1) in;
uniform ivec3 u_size;
uniform float u_wayShare; // steps a frame over nodes and SRS_WAY_UNITS

void main() {
    b_way = float(b_sum) * u_wayShare;
    for (int axis = 0; axis < 3; ++axis) {
        float low = unordered(b_bound[axis]), high = unordered(b_bound[3 + axis]);
        float size = max(high - low, 1e-6) / float(u_size[axis] - 3); // a voxel to spare on either side
        b_step[axis] = size;
        b_lowest[axis] = low - size;
    }
}
#else
layout(local_size_x = 64) in;
layout(std430) restrict readonly buffer b_nodes { uint b_texel[]; };
#ifdef WARP_WAYS
uniform sampler2D t_increments;
#else
uniform sampler2D t_positions;
#endif
uniform int u_nodes;

void main() {
    int node = int(gl_GlobalInvocationID.x);
    if (node >= u_nodes)
        return;
    ivec2 texel = ivec2(b_texel[node] & 0xffffu, b_texel[node] >> 16);
#ifdef WARP_WAYS
    atomicAdd(b_sum, uint(SRS_WAY_UNITS * min(length(texelFetch(t_increments, texel, 0).xyz), 1.0) + 0.5));
#else
    vec4 at = texelFetch(t_positions, texel, 0);
#ifdef WARP_CUT
    if (at.w < 0.0) // is on the other side of a cut, or loose
        return;
#endif
    for (int axis = 0; axis < 3; ++axis) {
        atomicMin(b_bound[axis], ordered(at[axis]));
        atomicMax(b_bound[3 + axis], ordered(at[axis]));
    }
#endif
}
#endif
