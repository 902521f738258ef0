// First passes of render/lattice_warp.h: bounds of the nodes; WARP_CUT: of those of a side; WARP_BINS: how many lie where within
// them; WARP_WAYS: how far they go in a step; WARP_FRAME: the voxels' box.
#version 450 core
#include "lattice_warp_box.glsl"
#if defined(WARP_FRAME) || defined(WARP_BINS)
uniform ivec3 u_size;
uniform float u_mostStep; // of a voxel, where pieces fell off, which would leave none for the rest

/// Of the box, where pieces fell off.
float mostLength(int axis) {
    return u_mostStep * float(u_size[axis] - 3);
}
#endif
#ifdef WARP_FRAME
layout(local_size_x = 3) in; // an axis each
uniform float u_wayShare; // steps a frame over nodes and SRS_WAY_UNITS

/// The longest part of the bounds without a node.
float gapOf(int axis, float low, float high) {
    float run = 0.0, longest = 0.0;
    for (int i = 0; i < SRS_WARP_BINS; ++i) {
        run = b_nodesIn[SRS_WARP_BINS * axis + i] > 0u ? 0.0 : run + (high - low) / SRS_WARP_BINS;
        longest = max(longest, run);
    }
    return longest;
}

/// Where most nodes lie within a length of the bounds; of places that have as many the highest: pieces fall.
float fullest(int axis, float low, float high, float most) {
    int width = max(int(SRS_WARP_BINS * most / (high - low)), 1), first = 0;
    uint held = 0u, best = 0u;
    for (int i = 0; i < SRS_WARP_BINS; ++i) {
        held += b_nodesIn[SRS_WARP_BINS * axis + i];
        if (i >= width)
            held -= b_nodesIn[SRS_WARP_BINS * axis + i - width];
        if (i >= width - 1 && held >= best) {
            best = held;
            first = i - width + 1;
        }
    }
    return low + (high - low) * float(first) / SRS_WARP_BINS;
}

void main() {
    int axis = int(gl_LocalInvocationID.x);
    if (axis == 0)
        b_way = float(b_sum) * u_wayShare;
    float low = unordered(b_bound[axis]), high = unordered(b_bound[3 + axis]);
    float most = mostLength(axis);
    // What is stretched has no gaps, and cells that reach further.
    if (high - low > 2.0 * most || high - low > most && gapOf(axis, low, high) >= SRS_WARP_GAP) {
        low = fullest(axis, low, high, most);
        high = low + most;
    }
    float size = max(high - low, 1e-6) / float(u_size[axis] - 3); // a voxel to spare on either side
    b_step[axis] = size;
    b_lowest[axis] = low - size;
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
#ifdef WARP_BINS
        float low = unordered(b_bound[axis]), high = unordered(b_bound[3 + axis]);
        if (high - low <= mostLength(axis)) // nobody asks
            continue;
        int bin = int(SRS_WARP_BINS * (at[axis] - low) / (high - low));
        atomicAdd(b_nodesIn[SRS_WARP_BINS * axis + clamp(bin, 0, SRS_WARP_BINS - 1)], 1u);
#else
        atomicMin(b_bound[axis], ordered(at[axis]));
        atomicMax(b_bound[3 + axis], ordered(at[axis]));
#endif
    }
#endif
}
#endif
