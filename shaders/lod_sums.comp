// Mass, momentum and inertia of a lattice's free nodes, a group a run of SRS_RUN nodes, always in the same order.
#version 450 core
#include "shared_constants.h"
#define GROUP 64
layout(local_size_x = GROUP) in;

layout(std430) readonly restrict buffer b_masses { uvec2 b_mass[]; }; // texel (y << 16 | x), mass share; 0: fixed
layout(std430) writeonly restrict buffer b_sums { vec4 b_sum[]; };    // SRS_LOD_SUMS a group
uniform int u_nodes;
uniform int u_first; // of the groups' slots
uniform float u_lengthScale, u_velocityScale, u_lead; // into the units of the level that is asked for
uniform sampler2D t_positions, t_increments, t_before;

shared vec4 s_sums[GROUP * SRS_LOD_SUMS];

void main() {
    int invocation = int(gl_LocalInvocationID.x), first = int(gl_WorkGroupID.x) * SRS_LOD_RUN;
    int last = min(first + SRS_LOD_RUN, u_nodes), slot = invocation * SRS_LOD_SUMS;
    vec4 sums[SRS_LOD_SUMS];
    for (int i = 0; i < SRS_LOD_SUMS; ++i)
        sums[i] = vec4(0.0);
    // From the first node: an organ may have moved far, and turn slowly.
    vec3 from = texelFetch(t_positions, ivec2(b_mass[0].x & 0xffffu, b_mass[0].x >> 16), 0).xyz;
    for (int node = first + invocation; node < last; node += GROUP) {
        ivec2 texel = ivec2(b_mass[node].x & 0xffffu, b_mass[node].x >> 16);
        float m = uintBitsToFloat(b_mass[node].y);
        vec3 x = u_lengthScale * (texelFetch(t_positions, texel, 0).xyz - from);
        vec3 u = texelFetch(t_increments, texel, 0).xyz;
        if (u_lead != 0.0)
            u += u_lead * (u - texelFetch(t_before, texel, 0).xyz);
        u *= u_velocityScale * m;
        sums[0] += vec4(u, m);
        sums[1] += vec4(cross(x, u), 0.0);
        sums[2] += vec4(m * x, 0.0);
        sums[3] += vec4(m * x * x, 0.0);
        sums[4] += vec4(m * x.xxy * x.yzz, 0.0); // xy, xz, yz
    }
    for (int i = 0; i < SRS_LOD_SUMS; ++i)
        s_sums[slot + i] = sums[i];
    barrier();
    for (int reach = GROUP / 2; reach > 0; reach /= 2) {
        if (invocation < reach)
            for (int i = 0; i < SRS_LOD_SUMS; ++i)
                s_sums[slot + i] += s_sums[slot + reach * SRS_LOD_SUMS + i];
        barrier();
    }
    if (invocation < SRS_LOD_SUMS)
        b_sum[(u_first + int(gl_WorkGroupID.x)) * SRS_LOD_SUMS + invocation] = s_sums[invocation];
}
