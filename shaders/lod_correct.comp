// The rigid motion that the target's momenta lack, from the sums of both levels: `missing` in sim/lod.cpp. One invocation.
#version 450 core
#include "shared_constants.h"
layout(local_size_x = 1) in;

#define INERTIA_FLOOR 1e-6 // of the trace, in float32: a line of nodes does not turn about itself

layout(std430) readonly restrict buffer b_sums { vec4 b_sum[]; };
layout(std430) writeonly restrict buffer b_motion { vec4 b_rigid[]; }; // a, w; c from the first node
uniform ivec2 u_groups; // of the source, of the target

void main() {
    vec4 wanted[SRS_LOD_SUMS], now[SRS_LOD_SUMS];
    for (int i = 0; i < SRS_LOD_SUMS; ++i) {
        wanted[i] = now[i] = vec4(0.0);
        for (int group = 0; group < u_groups.x; ++group)
            wanted[i] += b_sum[group * SRS_LOD_SUMS + i];
        for (int group = u_groups.x; group < u_groups.x + u_groups.y; ++group)
            now[i] += b_sum[group * SRS_LOD_SUMS + i];
    }
    float mass = now[0].w;
    vec3 a = vec3(0.0), w = vec3(0.0), c = vec3(0.0);
    if (mass > 0.0) {
        c = now[2].xyz / mass;
        a = (wanted[0].xyz - now[0].xyz) / mass;
        vec3 wantedCentre = wanted[2].xyz / max(wanted[0].w, 1e-20);
        vec3 spin = wanted[1].xyz - cross(wantedCentre, wanted[0].xyz) - (now[1].xyz - cross(c, now[0].xyz));
        vec3 d = now[3].xyz - mass * c * c, o = now[4].xyz - mass * c.xxy * c.yzz;
        float trace = d.x + d.y + d.z, diagonal = trace * (1.0 + INERTIA_FLOOR);
        mat3 inertia = mat3(diagonal - d.x, -o.x, -o.y, -o.x, diagonal - d.y, -o.z, -o.y, -o.z, diagonal - d.z);
        if (trace > 0.0)
            w = inverse(inertia) * spin;
    }
    b_rigid[0] = vec4(a, 0.0);
    b_rigid[1] = vec4(w, 0.0);
    b_rigid[2] = vec4(c, 0.0);
}
