// Conjugate gradients, last pass of an iteration: the next direction; and whether there is anything left to do. Once the
// residual is small enough, the passes of later iterations return at once.
#version 450 core
#include "implicit_common.glsl"
uniform int u_iteration; // whose direction it makes
uniform int u_round;     // Newton's
uniform float u_accuracy; // squared, of the first round's residual
uniform float u_floor;    // of r . z

void main() {
    if (b_doneAt < u_iteration - 1)
        return;
    float residual = takeSum(SRS_SUM_RESIDUAL + (u_iteration & 1)).x, before = 0.0;
    if (u_iteration > 0)
        before = takeSum(SRS_SUM_RESIDUAL + ((u_iteration + 1) & 1)).x;
    int i = int(gl_GlobalInvocationID.x);
    if (i < u_nodes) {
        vec4 z = VECTOR(SRS_VEC_Z, i);
        VECTOR(SRS_VEC_P, i) = u_iteration == 0 ? z : z + (residual / before) * VECTOR(SRS_VEC_P, i);
    }
    if (i == 0) {
        if (u_iteration == 0) {
            if (u_round == 0)
                b_first = residual;
            b_goal = max(u_accuracy * b_first, u_floor);
            b_doneAt = 1 << 30;
        } else {
            ++b_iterations;
        }
        if (!(residual > b_goal))
            b_doneAt = u_iteration - 1;
    }
}
