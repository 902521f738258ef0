// Sums the slots that solver_step.comp left, one work group a run of SRS_RUN texels, and clears them. Which values a sum
// adds and in which order depends on nothing but the texture's size, so the same run gives the same bytes; no float is
// added atomically. The few sums that remain are added on the CPU, in order.
#version 450 core
#include "shared_constants.h"
#define GROUP 128
layout(local_size_x = GROUP) in;

layout(std430) restrict buffer b_impulses { float b_impulse[]; };
layout(std430) restrict writeonly buffer b_sums { float b_sum[]; }; // (group * SRS_TOOLS + tool) * 3
uniform int u_texels;

shared vec3 s_sums[GROUP];

void main() {
    int invocation = int(gl_LocalInvocationID.x);
    int first = int(gl_WorkGroupID.x) * SRS_RUN;
    int last = min(first + SRS_RUN, u_texels);
    for (int tool = 0; tool < SRS_TOOLS; ++tool) {
        vec3 sum = vec3(0.0);
        for (int texel = first + invocation; texel < last; texel += GROUP) {
            int slot = (texel * SRS_TOOLS + tool) * 3;
            sum += vec3(b_impulse[slot], b_impulse[slot + 1], b_impulse[slot + 2]);
            b_impulse[slot] = b_impulse[slot + 1] = b_impulse[slot + 2] = 0.0;
        }
        s_sums[invocation] = sum;
        barrier();
        for (int reach = GROUP / 2; reach > 0; reach /= 2) {
            if (invocation < reach)
                s_sums[invocation] += s_sums[invocation + reach];
            barrier();
        }
        if (invocation == 0) {
            int slot = (int(gl_WorkGroupID.x) * SRS_TOOLS + tool) * 3;
            b_sum[slot] = s_sums[0].x;
            b_sum[slot + 1] = s_sums[0].y;
            b_sum[slot + 2] = s_sums[0].z;
        }
        barrier();
    }
}
