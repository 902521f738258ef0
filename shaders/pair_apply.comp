// After a round of the iteration: nodes take the impulses of the round, and step ahead for the next one. Twin of iterate()
// in sim/pair_contact.cpp.
#version 450 core
#include "pair_buffers.glsl"
layout(local_size_x = 64) in;

uniform uint u_nodes;
uniform uint u_given;
uniform float u_ahead; // of the next round; 0 after the last

void main() {
    uint node = gl_GlobalInvocationID.x;
    if (node >= u_nodes || b_sum[0] == 0u)
        return;
    uint at = u_given + 4u * node;
    if (b_sum[at + 3u] == 0u)
        return; // nothing touches it
    vec3 impulse = vec3(ivec3(int(b_sum[at]), int(b_sum[at + 1u]), int(b_sum[at + 2u]))) * (1.0 / SRS_PAIR_FIXED);
    vec3 now = b_motion[node].increment.xyz + b_motion[node].start.w * impulse;
    b_motion[node].increment.xyz = now + u_ahead * (now - b_motion[node].before.xyz);
    b_motion[node].before.xyz = now;
    for (uint i = 0u; i < 3u; ++i)
        b_sum[at + i] = 0u;
}
