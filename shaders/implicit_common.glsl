// What the passes of the implicit step share (sim/implicit_system.h has the equations, sim/implicit_gpu.h the order of
// passes): arrays, and sums over all nodes. Arrays stand one after another in a few buffers, as few as every OpenGL 4.5
// context must offer. Nodes and cells are numbered as in the lattice, not as in the textures.
//
// A sum is left as one vec4 a work group; every work group of the pass that needs it adds them up again, in the same
// order. So nothing is added atomically, nothing is read back, and no pass is needed for it alone.
#include "shared_constants.h"
#include "implicit_constants.h"
layout(local_size_x = SRS_IMPLICIT_GROUP) in;

layout(std430) buffer b_vectors { vec4 b_vector[]; }; // SRS_VEC_...
layout(std430) buffer b_sums { vec4 b_sum[]; };
layout(std430) buffer b_progress {
    float b_goal;      // of r . z in this step
    float b_first;     // r . z where the step's first round began
    int b_doneAt;      // iteration in which this round reached its goal
    int b_iterations;  // of the step so far
    float b_share;     // of the last Newton step
};
uniform int u_nodes;
uniform int u_groups; // work groups of a pass that leaves sums

#define VECTOR(array, i) b_vector[(array) * u_nodes + (i)]

shared vec4 s_sums[SRS_IMPLICIT_GROUP];

vec4 sumOfGroup(vec4 mine) {
    int local = int(gl_LocalInvocationID.x);
    s_sums[local] = mine;
    barrier();
    for (int reach = SRS_IMPLICIT_GROUP / 2; reach > 0; reach /= 2) {
        if (local < reach)
            s_sums[local] += s_sums[local + reach];
        barrier();
    }
    vec4 sum = s_sums[0];
    barrier();
    return sum;
}

/// Every invocation of the pass comes here.
void leaveSum(int slot, vec4 mine) {
    vec4 sum = sumOfGroup(mine);
    if (gl_LocalInvocationID.x == 0u)
        b_sum[slot * u_groups + int(gl_WorkGroupID.x)] = sum;
}

vec4 takeSum(int slot) {
    vec4 mine = vec4(0.0);
    for (int group = int(gl_LocalInvocationID.x); group < u_groups; group += SRS_IMPLICIT_GROUP)
        mine += b_sum[slot * u_groups + group];
    return sumOfGroup(mine);
}

bool isHeld(int node) { return VECTOR(SRS_VEC_V, node).w == 0.0; }
