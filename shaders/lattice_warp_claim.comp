// Second pass of render/lattice_warp.h: a work group a cell, over the voxels around it; WARP_CUT: for each side of the cuts.
#version 450 core
#include "lattice_warp.glsl"
layout(local_size_x = SRS_WARP_GROUP) in;

layout(r32ui) uniform restrict uimage3D i_owner; // one volume a side, above each other
uniform ivec3 u_size;
uniform int u_cells;

shared vec4 s_corner[8];

/// Does the side have this cell, which may be a copy of one that a cut crosses?
bool isHere() {
#ifdef WARP_CUT
    bool crosses = false, own = false;
    for (int i = 0; i < 8; ++i) {
        float w = s_corner[i].w;
        if (w == SRS_SIDE_NONE)
            return false;
        crosses = crosses || w < 0.0;
        own = own || w > -SRS_SIDE_ON && w < SRS_SIDE_FAR;
    }
    return own || !crosses;
#else
    return true;
#endif
}

/// How far on the other side of a cut a place in the cell lies, spacings.
float acrossBy(vec3 s) {
    float on = 0.0;
#ifdef WARP_CUT
    for (int i = 0; i < 8; ++i) {
        vec3 w = mix(1.0 - s, s, vec3(i & 1, i >> 1 & 1, i >> 2));
        on += w.x * w.y * w.z * s_corner[i].w;
    }
#endif
    return max(-on, 0.0);
}

void claim(uint cell, int side) {
    vec3 low = s_corner[0].xyz, high = low, corner[8];
    bool beside = false; // a cut
    for (int i = 0; i < 8; ++i) {
        corner[i] = s_corner[i].xyz;
#ifdef WARP_CUT
        beside = beside || s_corner[i].w < SRS_WARP_BESIDE;
#endif
        low = min(low, corner[i]);
        high = max(high, corner[i]);
    }
    Trilinear map = trilinearOf(corner);
    vec3 more = SRS_WARP_REACH * (high - low);
    ivec3 first = max(ivec3(ceil((low - more - b_lowest.xyz) / b_step.xyz)), ivec3(0));
    ivec3 last = min(ivec3(floor((high + more - b_lowest.xyz) / b_step.xyz)), u_size - 1);
    ivec3 count = max(last - first + 1, ivec3(0));
    for (int i = int(gl_LocalInvocationID.x); i < count.x * count.y * count.z; i += SRS_WARP_GROUP) {
        ivec3 voxel = first + ivec3(i % count.x, i / count.x % count.y, i / count.x / count.y);
        vec3 s;
        if (!invert(map, b_lowest.xyz + vec3(voxel) * b_step.xyz, s))
            continue;
        float away = outsideBy(s), across = acrossBy(s);
        if (away <= SRS_WARP_REACH && across <= SRS_WARP_ACROSS)
            imageAtomicMin(i_owner, voxel + ivec3(0, 0, side * u_size.z),
                           ownerOf(away + across, beside, cell));
    }
}

void main() {
    for (uint cell = gl_WorkGroupID.x; cell < uint(u_cells); cell += gl_NumWorkGroups.x)
        for (int side = 0; side < kSides; ++side) {
            barrier();
            uint k = gl_LocalInvocationID.x;
            if (k < 8u)
                s_corner[k] = nodeOf(b_cell[cell].texels[k], side);
            barrier();
            if (isHere())
                claim(cell, side);
        }
}
