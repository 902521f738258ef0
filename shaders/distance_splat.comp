// First passes of render/distance_volume.h: each triangle over the voxels within the band of it. DISTANCE_CLAIM: the second
// of them, in which a triangle whose distance was the least leaves its index (the lowest of equals).
#version 450 core
#include "raycast_constants.h"
#include "distance_triangle.glsl"
layout(local_size_x = 32, local_size_y = 1) in;

layout(r32ui) uniform restrict uimage3D i_least;
#ifdef DISTANCE_CLAIM
layout(r32ui) uniform restrict uimage3D i_owner;
#endif
uniform ivec3 u_size;
uniform float u_band; // voxels
uniform int u_triangles;

void main() {
    uint triangle = gl_GlobalInvocationID.x;
    if (triangle >= uint(u_triangles))
        return;
    uvec3 t = b_triangle[triangle].xyz;
    vec3 a = b_position[t.x].xyz, b = b_position[t.y].xyz, c = b_position[t.z].xyz;
    ivec3 low = max(ivec3(ceil(min(min(a, b), c) - u_band)), ivec3(0));
    ivec3 high = min(ivec3(floor(max(max(a, b), c) + u_band)), u_size - 1);
    for (int z = low.z + int(gl_GlobalInvocationID.y); z <= high.z; z += SRS_SPLAT_SLICES)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                int feature;
                vec3 p = vec3(x, y, z);
                precise float far = distance(p, closestOnTriangle(p, a, b, c, feature));
                if (far > u_band)
                    continue;
#ifdef DISTANCE_CLAIM
                if (imageLoad(i_least, ivec3(x, y, z)).x == floatBitsToUint(far))
                    imageAtomicMin(i_owner, ivec3(x, y, z), triangle);
#else
                imageAtomicMin(i_least, ivec3(x, y, z), floatBitsToUint(far));
#endif
            }
}
