// Residuals of one coarser level, from the level below (ImplicitSystem::precondition, downwards).
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_multilevel.glsl"
uniform int u_level;
uniform int u_iteration;

void main() {
    if (b_doneAt < u_iteration)
        return;
    int i = int(gl_GlobalInvocationID.x);
    if (i < levelInt(u_level, SRS_LEVEL_NODES))
        restrictTo(u_level, i);
}
