// Last pass of render/lattice_warp.h: the displacement of each claimed voxel, of one side of the cuts.
#version 450 core
#include "lattice_warp.glsl"
layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;

layout(r32ui) uniform restrict readonly uimage3D i_owner;
layout(rgba32f) uniform restrict writeonly image3D i_displacement;
uniform ivec3 u_size;
uniform int u_side;

void main() {
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(voxel, u_size)))
        return;
    int side = u_side;
    uint owner = imageLoad(i_owner, voxel + ivec3(0, 0, side * u_size.z)).x;
#ifdef WARP_CUT
    // A place is of the cell that it is nearest to, whosever that is; but what goes on past a cut does so on its own side alone.
    uint other = imageLoad(i_owner, voxel + ivec3(0, 0, (1 - side) * u_size.z)).x;
    if (outsideOf(other) < outsideOf(owner) && !goesOn(owner) && !goesOn(other)) {
        side = 1 - side;
        owner = other;
    }
#endif
    vec4 texel = vec4(0.0);
    if (owner != kNobody) {
        uint cell = cellOf(owner);
        vec3 corner[8], at = b_lowest.xyz + vec3(voxel) * b_step.xyz, s;
        for (int k = 0; k < 8; ++k)
            corner[k] = nodeOf(b_cell[cell].texels[k], side).xyz;
        invert(trilinearOf(corner), at, s);
        texel = vec4(b_cell[cell].rest.xyz + s - at, 1.0);
    }
    imageStore(i_displacement, voxel, texel);
}
