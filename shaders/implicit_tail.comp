// The coarse levels of the preconditioner, from u_level on, in one work group: down, the dense inverse of the last one,
// and up again.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_multilevel.glsl"
layout(std430) readonly buffer b_coarsest { float b_inverse[]; }; // then the scales
uniform int u_level;
uniform int u_iteration;

#define SIZE (3 * SRS_IMPLICIT_COARSEST)
shared float s_residual[SIZE];

void main() {
    if (b_doneAt < u_iteration)
        return;
    int local = int(gl_LocalInvocationID.x), last = u_levels - 1;
    for (int level = u_level; level <= last; ++level) {
        for (int i = local; i < levelInt(level, SRS_LEVEL_NODES); i += SRS_IMPLICIT_GROUP)
            restrictTo(level, i);
        memoryBarrierBuffer();
        barrier();
    }
    int nodes = levelInt(last, SRS_LEVEL_NODES), size = 3 * nodes, at = levelInt(last, SRS_LEVEL_VECTORS);
    for (int i = local; i < size; i += SRS_IMPLICIT_GROUP)
        s_residual[i] = b_level[at + i / 3][i % 3] * b_inverse[size * size + i];
    barrier();
    for (int i = local; i < size; i += SRS_IMPLICIT_GROUP) {
        float sum = 0.0;
        for (int j = 0; j < size; ++j)
            sum += b_inverse[j * size + i] * s_residual[j]; // symmetric: along columns, side by side
        b_level[at + nodes + i / 3][i % 3] = sum * b_inverse[size * size + i];
    }
    memoryBarrierBuffer();
    barrier();
    for (int level = last - 1; level >= u_level; --level) {
        for (int i = local; i < levelInt(level, SRS_LEVEL_NODES); i += SRS_IMPLICIT_GROUP)
            prolongTo(level, i);
        memoryBarrierBuffer();
        barrier();
    }
}
