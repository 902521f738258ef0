// Corrections of one level from the next coarser one (ImplicitSystem::precondition, upwards). On level 0 that is the
// preconditioned residual, whose product with the residual is left.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_multilevel.glsl"
uniform int u_level;
uniform int u_iteration; // it prepares this one

void main() {
    if (b_doneAt < u_iteration - 1)
        return;
    int i = int(gl_GlobalInvocationID.x);
    if (u_level > 0) {
        if (i < levelInt(u_level, SRS_LEVEL_NODES))
            prolongTo(u_level, i);
        return;
    }
    float product = 0.0;
    if (i < u_nodes) {
        vec3 residual = VECTOR(SRS_VEC_R, i).xyz, z = vec3(0.0);
        if (!isHeld(i)) {
            Symmetric inverse = Symmetric(VECTOR(SRS_VEC_DA, i).xyz, VECTOR(SRS_VEC_DB, i).xyz);
            z = times(inverse, residual) + fromCoarser(0, i);
        }
        VECTOR(SRS_VEC_Z, i) = vec4(z, 0.0);
        product = dot(residual, z);
    }
    leaveSum(SRS_SUM_RESIDUAL + (u_iteration & 1), vec4(product));
}
