// What the coupling stage changed of an organ's nodes, back into its state textures: position and increment both move.
#version 450 core
#include "pair_buffers.glsl"
layout(local_size_x = 64) in;

layout(rgba32f) uniform restrict image2D i_positions;
layout(rgba32f) uniform restrict image2D i_increments;
uniform uint u_organ;

void main() {
    uint at = gl_GlobalInvocationID.x;
    PairOrgan organ = b_organ[u_organ];
    if (at >= organ.touches.z)
        return;
    uint node = organ.range.x + at;
    vec3 increment = b_motion[node].increment.xyz, original = b_motion[node].original.xyz;
    if (increment == original)
        return;
    vec4 by = vec4((increment - original) / organ.place.w, 0.0);
    ivec2 texel = ivec2(b_node[node].more.w & 0xffff, b_node[node].more.w >> 16);
    imageStore(i_positions, texel, imageLoad(i_positions, texel) + by);
    imageStore(i_increments, texel, imageLoad(i_increments, texel) + by);
}
