// Second pass of render/lattice_warp.h: a work group a cell, over the voxels around it.
#version 450 core
#include "lattice_warp.glsl"
layout(local_size_x = SRS_WARP_GROUP) in;

layout(r32ui) uniform restrict uimage3D i_owner;
uniform ivec3 u_size;
uniform int u_cells;

shared vec3 s_corner[8];

void main() {
    for (uint cell = gl_WorkGroupID.x; cell < uint(u_cells); cell += gl_NumWorkGroups.x) {
        barrier();
        uint k = gl_LocalInvocationID.x;
        if (k < 8u) {
            uint texel = b_cell[cell].texels[k];
            s_corner[k] = texelFetch(t_positions, ivec2(texel & 0xffffu, texel >> 16), 0).xyz;
        }
        barrier();
        vec3 low = s_corner[0], high = low, corner[8];
        for (int i = 0; i < 8; ++i) {
            corner[i] = s_corner[i];
            low = min(low, corner[i]);
            high = max(high, corner[i]);
        }
        Trilinear map = trilinearOf(corner);
        vec3 more = SRS_WARP_REACH * (high - low);
        ivec3 first = max(ivec3(ceil((low - more - b_lowest.xyz) / b_step.xyz)), ivec3(0));
        ivec3 last = min(ivec3(floor((high + more - b_lowest.xyz) / b_step.xyz)), u_size - 1);
        ivec3 count = max(last - first + 1, ivec3(0));
        for (int i = int(k); i < count.x * count.y * count.z; i += SRS_WARP_GROUP) {
            ivec3 voxel = first + ivec3(i % count.x, i / count.x % count.y, i / count.x / count.y);
            vec3 s;
            if (!invert(map, b_lowest.xyz + vec3(voxel) * b_step.xyz, s))
                continue;
            float away = outsideBy(s);
            if (away <= SRS_WARP_REACH)
                imageAtomicMin(i_owner, voxel, uint(min(away * 4000.0, 4094.0)) << 20 | cell);
        }
    }
}
