// Threads and clips in one step: twin of ThreadHold::solve in sim/thread_hold.cpp, which says what they do. One
// invocation takes all of them in turn.
#version 450 core
#include "pair_buffers.glsl"
layout(local_size_x = 1) in;

struct HeldThread {
    uint node[16];
    float weight[16]; // of the first end's nodes above 0, of the second's below
    float length, tightening, strength, pull; // group units; s; group units of impulse a step; group units a step
    int clip, unused0, unused1, unused2;
};
layout(std430) restrict readonly buffer b_threads { HeldThread b_thread[]; };

struct ThreadNow { // group units; sums since they were last taken
    float startLength, force, most, broken, brokenAfter, impulse, work, given;
};
layout(std430) restrict buffer b_threadStates { ThreadNow b_threadNow[]; };

uniform int u_threads;
uniform float u_elapsed[SRS_MAX_THREADS]; // s from when each is tied to where the step begins; below 0: not yet
uniform float u_timeStep;                 // s
uniform float u_meanShare;

bool holds(int i) { return b_threadNow[i].startLength >= 0.0 && b_threadNow[i].broken == 0.0; }

float lengthAt(int i, float elapsed) {
    float way = b_threadNow[i].startLength - b_thread[i].length;
    if (way < 0.0 && b_thread[i].clip == 0)
        return b_thread[i].length;
    float within = max(b_thread[i].tightening, abs(way) / b_thread[i].pull * u_timeStep);
    float share = within > 0.0 ? clamp(elapsed / within, 0.0, 1.0) : 1.0;
    return b_thread[i].length + way * (1.0 - share);
}

void hold(int i) {
    vec3 began = vec3(0.0), moved = vec3(0.0);
    float answer = 0.0;
    for (int k = 0; k < 16; ++k) {
        PairMotion motion = b_motion[b_thread[i].node[k]];
        float weight = b_thread[i].weight[k];
        began += weight * motion.start.xyz;
        moved += weight * motion.increment.xyz;
        answer += weight * weight * motion.start.w;
    }
    vec3 now = began + moved;
    float apart = length(now), wanted = lengthAt(i, u_elapsed[i] + u_timeStep);
    if (!(apart > 1e-6) || !(answer > 0.0))
        return;
    vec3 direction = now / apart;
    float shift = apart - wanted;
    if (dot(began, now) > 0.5 * length(began) * apart) {
        vec3 first = normalize(began);
        float along = dot(now, first);
        vec3 aside = now - along * first;
        float inside = wanted * wanted - dot(aside, aside);
        if (inside >= 0.0) {
            direction = first;
            shift = along - sqrt(inside);
        }
    }
    float given = b_threadNow[i].given, pull = given + shift / answer;
    if (b_thread[i].clip == 0)
        pull = max(pull, 0.0);
    b_threadNow[i].given = pull;
    vec3 impulse = (pull - given) * direction;
    for (int k = 0; k < 16; ++k) {
        uint node = b_thread[i].node[k];
        vec3 increment = b_motion[node].increment.xyz - b_thread[i].weight[k] * b_motion[node].start.w * impulse;
        b_motion[node].increment.xyz = increment;
        b_motion[node].before.xyz = increment; // where the contacts' iteration begins
    }
}

void main() {
    for (int i = 0; i < u_threads; ++i) {
        b_threadNow[i].given = 0.0;
        if (u_elapsed[i] < 0.0 || b_threadNow[i].startLength >= 0.0)
            continue;
        vec3 between = vec3(0.0);
        for (int k = 0; k < 16; ++k)
            between += b_thread[i].weight[k] * b_motion[b_thread[i].node[k]].start.xyz;
        b_threadNow[i].startLength = length(between);
    }
    for (int sweep = 0; sweep < SRS_THREAD_SWEEPS; ++sweep)
        for (int i = 0; i < u_threads; ++i)
            if (holds(i))
                hold(i);
    for (int i = 0; i < u_threads; ++i) {
        if (!holds(i))
            continue;
        float force = b_threadNow[i].given; // an impulse a step
        b_threadNow[i].impulse += force;
        b_threadNow[i].work += max(0.0, force * (lengthAt(i, u_elapsed[i]) - lengthAt(i, u_elapsed[i] + u_timeStep)));
        b_threadNow[i].force += (abs(force) - b_threadNow[i].force) * u_meanShare;
        b_threadNow[i].most = max(b_threadNow[i].most, b_threadNow[i].force);
        if (b_threadNow[i].force > b_thread[i].strength) {
            b_threadNow[i].broken = 1.0;
            b_threadNow[i].brokenAfter = u_elapsed[i] + u_timeStep;
            b_threadNow[i].force = 0.0;
        }
    }
}
