// Conjugate gradients, second pass of an iteration: the step along the direction, and the residual. As the pass that
// begins (iteration -1) it takes from the residual what held nodes' moves do to the others.
#version 450 core
#include "implicit_common.glsl"
uniform int u_iteration;

void main() {
    if (b_doneAt < u_iteration)
        return;
    int i = int(gl_GlobalInvocationID.x);
    if (u_iteration < 0) {
        if (i < u_nodes)
            VECTOR(SRS_VEC_R, i) -= VECTOR(SRS_VEC_Q, i);
        return;
    }
    float curvature = takeSum(SRS_SUM_CURVATURE).x;
    float residual = takeSum(SRS_SUM_RESIDUAL + (u_iteration & 1)).x;
    float share = curvature > 0.0 ? residual / curvature : 0.0;
    if (i < u_nodes) {
        VECTOR(SRS_VEC_S, i) += share * VECTOR(SRS_VEC_P, i);
        VECTOR(SRS_VEC_R, i) -= share * VECTOR(SRS_VEC_Q, i);
    }
}
