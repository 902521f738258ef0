// Takes Newton's step: the largest of four shares that lets Phi fall, or none. Where the search begins, the share of the
// guess that lets it fall most. Twin of ImplicitStepper::start and takeShare.
#version 450 core
#include "implicit_common.glsl"
uniform vec4 u_shares;
uniform int u_mode; // 0: the start, 1: a step, 2: all of a step that held nodes' moves are part of

void main() {
    vec4 changes = takeSum(SRS_SUM_CHANGES);
    float promise = takeSum(SRS_SUM_PROMISE).x, share = 0.0;
    if (u_mode == 0) {
        float least = 0.0;
        for (int k = 0; k < 4; ++k)
            if (changes[k] < least) {
                least = changes[k];
                share = u_shares[k];
            }
    } else if (u_mode == 2) {
        share = 1.0;
    } else {
        for (int k = 3; k >= 0; --k)
            if (changes[k] <= SRS_IMPLICIT_ARMIJO * u_shares[k] * promise)
                share = u_shares[k];
    }
    int i = int(gl_GlobalInvocationID.x);
    if (i < u_nodes) {
        vec4 taken = share * VECTOR(SRS_VEC_S, i);
        VECTOR(SRS_VEC_U, i) += taken;
        VECTOR(SRS_VEC_S, i) = taken;
    }
    if (i == 0) {
        b_doneAt = 1 << 30;
        b_share = u_mode == 0 ? 1.0 : min(b_share, share);
    }
}
