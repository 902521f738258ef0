// One round of the iteration, a touch an invocation at a time: twin of iterate() in sim/pair_contact.cpp. Impulses are
// rounded to integers, and the third corner of the triangle takes what the others leave: what one organ gets, the other
// gives to the last bit, in whatever order they are added.
#version 450 core
#include "pair_buffers.glsl"
layout(local_size_x = 64) in;

uniform float u_ahead;    // Nesterov's share of the last round's change
uniform float u_friction;
uniform uint u_given;
uniform int u_last;       // 1: the last round: loads are summed up
uniform uint u_organs;

uint countOf(uint node) { return b_sum[u_given + 4u * node + 3u]; }

/// To the nearest multiple of 1/SRS_PAIR_FIXED, within what can be summed up.
ivec3 fixedOf(vec3 impulse) { return ivec3(round(clamp(impulse, -8.0, 8.0) * SRS_PAIR_FIXED)); }

void give(uint node, ivec3 impulse) {
    for (int axis = 0; axis < 3; ++axis)
        if (impulse[axis] != 0)
            atomicAdd(b_sum[u_given + 4u * node + uint(axis)], uint(impulse[axis]));
}

/// Adds to a sum of 64 bits.
void addLoad(uint at, int value) {
    uint low = uint(value);
    uint carry = atomicAdd(b_sum[at], low) > 0xffffffffu - low ? 1u : 0u;
    uint high = (value < 0 ? 0xffffffffu : 0u) + carry;
    if (high != 0u)
        atomicAdd(b_sum[at + 1u], high);
}

void addLoads(uint organ, uint other, ivec4 given) {
    uint at = SRS_PAIR_LOADS + 8u * (organ * u_organs + other);
    for (int i = 0; i < 4; ++i)
        if (given[i] != 0)
            addLoad(at + 2u * uint(i), given[i]);
}

void main() {
    uint touches = b_sum[0];
    for (uint i = gl_GlobalInvocationID.x; i < touches; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        PairTouch t = b_touch[i];
        vec3 motion = b_motion[t.who.x].increment.xyz;
        float answer = float(countOf(t.who.x)) * b_motion[t.who.x].start.w;
        for (int k = 0; k < 3; ++k) {
            uint corner = t.who[k + 1];
            motion -= t.weights[k] * b_motion[corner].increment.xyz;
            answer += t.weights[k] * t.weights[k] * float(countOf(corner)) * b_motion[corner].start.w;
        }
        if (!(answer > 0.0))
            continue;
        vec4 from = t.impulse + u_ahead * (t.impulse - t.last);
        float along = dot(t.normal.xyz, motion);
        vec4 now = vec4(0.0, 0.0, 0.0, max(0.0, from.w - (t.normal.w + along) / answer));
        if (u_friction > 0.0) {
            now.xyz = from.xyz - (motion - along * t.normal.xyz) / answer;
            float most = u_friction * now.w, size = length(now.xyz);
            if (size > most)
                now.xyz *= most / size;
        }
        ivec3 impulse = fixedOf((now.w - from.w) * t.normal.xyz + (now.xyz - from.xyz));
        ivec3 first = ivec3(round(t.weights.x * vec3(impulse))), second = ivec3(round(t.weights.y * vec3(impulse)));
        give(t.who.x, impulse);
        give(t.who.y, -first);
        give(t.who.z, -second);
        give(t.who.w, first + second - impulse);
        b_touch[i].last = t.impulse;
        b_touch[i].impulse = now;
        if (u_last != 0) {
            ivec4 given = ivec4(fixedOf(now.w * t.normal.xyz + now.xyz), fixedOf(vec3(now.w)).x);
            uint organs = floatBitsToUint(t.weights.w), own = organs >> 8 & 255u, other = organs & 255u;
            if (own != other) {
                addLoads(own, other, given);
                addLoads(other, own, ivec4(-given.xyz, given.w));
            } else {
                addLoads(own, own, ivec4(0, 0, 0, given.w));
            }
        }
    }
}
