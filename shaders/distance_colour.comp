// Colours of render/distance_volume.h: that of the nearest place of the surface.
#version 450 core
#include "distance_triangle.glsl"
layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;

layout(std430) restrict readonly buffer b_colours { uint b_colour[]; }; // RGBA8, one a vertex
layout(r32ui) uniform restrict readonly uimage3D i_nearest;            // triangle that is nearest to a voxel
layout(r32ui) uniform restrict writeonly uimage3D i_colour;
uniform ivec3 u_size;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, u_size)))
        return;
    uint triangle = imageLoad(i_nearest, at).x;
    vec4 colour = vec4(0.0);
    if (triangle != 0xffffffffu) {
        int feature;
        vec3 p = closestOf(triangle, vec3(at), feature);
        uvec3 t = b_triangle[triangle].xyz;
        vec3 a = b_position[t.x].xyz, b = b_position[t.y].xyz, c = b_position[t.z].xyz;
        vec3 share = vec3(length(cross(b - p, c - p)), length(cross(c - p, a - p)), length(cross(a - p, b - p)));
        share /= max(share.x + share.y + share.z, 1e-12);
        colour = share.x * unpackUnorm4x8(b_colour[t.x]) + share.y * unpackUnorm4x8(b_colour[t.y]) +
                 share.z * unpackUnorm4x8(b_colour[t.z]);
    }
    imageStore(i_colour, at, uvec4(packUnorm4x8(colour)));
}
