// From an organ's state textures to the motion of its nodes in group units: twin of CpuCoupling::read in
// sim/organ_group.cpp. Clears what the step sums up.
#version 450 core
#include "pair_buffers.glsl"
layout(local_size_x = 64) in;

layout(rgba32f) uniform readonly restrict image2D i_positions;
layout(rgba32f) uniform readonly restrict image2D i_increments;
layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
uniform uint u_organ;
uniform uint u_given;

void main() {
    uint at = gl_GlobalInvocationID.x;
    PairOrgan organ = b_organ[u_organ];
    if (at == 0u) {
        b_sum[0] = 0u;
        b_sum[uint(SRS_PAIR_FASTEST) + u_organ] = 0u;
    }
    if (at >= organ.touches.z)
        return;
    uint node = organ.range.x + at;
    ivec2 texel = ivec2(b_node[node].more.w & 0xffff, b_node[node].more.w >> 16);
    vec3 position = imageLoad(i_positions, texel).xyz, increment = imageLoad(i_increments, texel).xyz;
    bool held = ((imageLoad(i_nodeInfo, texel).x >> SRS_HELD_SHIFT) & SRS_HELD_MASK) != 0u;
    vec4 moved = vec4(organ.place.w * increment, 0.0);
    b_motion[node].start = vec4(organ.place.xyz + organ.place.w * (position - increment), held ? 0.0 : b_node[node].kind.z);
    b_motion[node].increment = moved;
    b_motion[node].original = moved;
    b_motion[node].before = moved;
    for (uint i = 0u; i < 4u; ++i)
        b_sum[u_given + 4u * node + i] = 0u;
}
