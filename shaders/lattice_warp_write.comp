// Last pass of render/lattice_warp.h: the displacement of each claimed voxel.
#version 450 core
#include "lattice_warp.glsl"
layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;

layout(r32ui) uniform restrict readonly uimage3D i_owner;
layout(rgba32f) uniform restrict writeonly image3D i_displacement;
uniform ivec3 u_size;

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(voxel, u_size)))
        return;
    uint owner = imageLoad(i_owner, voxel).x;
    vec4 texel = vec4(0.0);
    if (owner != 0xffffffffu) {
        uint cell = owner & 0xfffffu;
        vec3 corner[8], at = b_lowest.xyz + vec3(voxel) * b_step.xyz, s;
        cornersOf(cell, corner);
        invert(trilinearOf(corner), at, s);
        texel = vec4(b_cell[cell].rest.xyz + s - at, 1.0);
    }
    imageStore(i_displacement, voxel, texel);
}
