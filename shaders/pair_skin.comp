// Points and normals of the skins where the step began: twin of placeSkin in sim/pair_contact_skin.cpp. Notes the
// longest increment of each organ: bits of floats that are not negative are ordered as they are.
#version 450 core
#include "pair_buffers.glsl"
layout(local_size_x = 64) in;

uniform uint u_nodes; // of the group

vec3 besideOf(int other, uint node) { return b_motion[other >= 0 ? uint(other) : node].start.xyz; }

vec3 column(int up, int down, uint node, vec3 otherwise) {
    if (up < 0 && down < 0)
        return otherwise;
    return (besideOf(up, node) - besideOf(down, node)) * (up >= 0 && down >= 0 ? 0.5 : 1.0);
}

void main() {
    uint node = gl_GlobalInvocationID.x;
    if (node >= u_nodes)
        return;
    PairNode own = b_node[node];
    PairOrgan organ = b_organ[own.more.z];
    if (node >= organ.range.x + organ.range.y)
        return; // not of the skin
    float scale = organ.place.w;
    vec3 x = column(own.beside.x, own.beside.y, node, vec3(scale, 0.0, 0.0));
    vec3 y = column(own.beside.z, own.beside.w, node, vec3(0.0, scale, 0.0));
    vec3 z = column(own.more.x, own.more.y, node, vec3(0.0, 0.0, scale));
    vec3 moved = own.rest.x * cross(y, z) + own.rest.y * cross(z, x) + own.rest.z * cross(x, y);
    float size = length(moved);
    vec3 normal = size > 1e-9 * scale * scale ? moved / size : own.rest.xyz;
    b_skin[node].point = vec4(b_motion[node].start.xyz + own.rest.w * normal, 0.0);
    b_skin[node].normal = vec4(own.kind.y * normal, own.kind.x);
    vec3 increment = b_motion[node].increment.xyz;
    float fastest = dot(increment, increment);
    atomicMax(b_sum[SRS_PAIR_FASTEST + own.more.z], fastest >= 0.0 ? floatBitsToUint(fastest) : 0u);
}
