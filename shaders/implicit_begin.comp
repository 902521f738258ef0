// The first pass of an implicit step: what the state textures hold, as arrays. Twin of ImplicitSolver::step
// (sim/implicit_solver.cpp).
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#ifdef SRS_CONTACT
#include "contact_colliders.glsl"
#endif

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_positions;
layout(rgba32f) uniform readonly restrict image2D i_increments;
layout(rgba32f) uniform readonly restrict image2D i_earlier; // LatticeState::earlier
layout(std430) writeonly buffer b_connections { uint b_connection[]; };
layout(std430) readonly buffer b_masses { float b_mass[]; };

uint holderOf(uint info) { return (info >> SRS_HELD_SHIFT) & SRS_HELD_MASK; }

/// Does the step say where the node goes?
bool goesAsTold(uint info) {
    if ((info & SRS_FLAG_FIXED) != 0u)
        return true;
#ifdef SRS_CONTACT
    return holderOf(info) != 0u && holdsEndlessly(int(holderOf(info)) - 1);
#else
    return false;
#endif
}

#ifdef SRS_CONTACT
/// Of the neighbours' increments that have one before. Twin of ImplicitSolver::guessTouched.
vec3 meanChange(int node, uint bits) {
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
        int other = ((bits >> d) & 1u) != 0u ? neighbourOf(node, d) : -1;
        if (other < 0)
            continue;
        ivec2 texel = texelOf(other);
        vec4 earlier = imageLoad(i_earlier, texel);
        if (earlier.w > 0.0 && !goesAsTold(imageLoad(i_nodeInfo, texel).x)) {
            sum += imageLoad(i_increments, texel).xyz - earlier.xyz;
            count += 1.0;
        }
    }
    return sum / max(count, 1.0);
}
#endif

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i == 0) {
        b_iterations = 0;
        b_share = 1.0;
    }
    if (i >= u_nodes)
        return;
    ivec2 texel = texelOf(i);
    uint info = imageLoad(i_nodeInfo, texel).x;
    vec3 x = imageLoad(i_positions, texel).xyz, u = imageLoad(i_increments, texel).xyz;
    vec4 earlier = imageLoad(i_earlier, texel);
    vec4 expected = vec4(u, 1.0);
    vec3 target = u;
    if (goesAsTold(info)) {
        expected.w = 0.0;
        target = vec3(0.0);
#ifdef SRS_CONTACT
        if (holderOf(info) != 0u)
            target = vec3(carried(int(holderOf(info)) - 1, real3(x)) - real3(x));
    } else if (earlier.w < 0.0) {
        target = u + meanChange(i, info & SRS_CONNECTION_MASK);
#endif
    } else if (earlier.w > 0.0) {
        vec3 change = u - earlier.xyz;
        expected = vec4(u + 0.5 * change, 0.5);
        target = u + change;
    }
    b_connection[i] = info & SRS_CONNECTION_MASK;
    VECTOR(SRS_VEC_G, i) = vec4(0.0);
    VECTOR(SRS_VEC_X, i) = vec4(x, b_mass[i]);
    VECTOR(SRS_VEC_V, i) = expected;
    VECTOR(SRS_VEC_T, i) = vec4(target, 0.0);
    VECTOR(SRS_VEC_U, i) = vec4(0.0);
    // The search's first direction: free nodes only.
    VECTOR(SRS_VEC_S, i) = expected.w == 0.0 ? vec4(0.0) : vec4(target, 0.0);
#ifdef SRS_CONTACT
    // What the last step ended with.
    bool touched = earlier.w < 0.0;
    VECTOR(SRS_VEC_F, i) = VECTOR(SRS_VEC_KA, i) = VECTOR(SRS_VEC_KB, i) = vec4(0.0);
    VECTOR(SRS_VEC_N, i) = vec4(vec3(0.0), touched ? 1.0 : 0.0);
    VECTOR(SRS_VEC_A, i) = vec4(vec3(0.0), earlier.w < -1.5 ? 1.0 : 0.0);
    VECTOR(SRS_VEC_W, i).xyz = touched ? earlier.xyz : vec3(0.0);
#endif
}
