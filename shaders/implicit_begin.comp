// The first pass of an implicit step: what the state textures hold, as arrays. Twin of ImplicitSolver::step
// (sim/implicit_solver.cpp).
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_positions;
layout(rgba32f) uniform readonly restrict image2D i_increments;
layout(rgba32f) uniform readonly restrict image2D i_earlier; // the increments before; w: 1 where there is one
layout(std430) writeonly buffer b_connections { uint b_connection[]; };
layout(std430) readonly buffer b_masses { float b_mass[]; };
#if SRS_TOOLS > 0
uniform vec4 u_moves[SRS_TOOLS]; // of what each tool holds, in this step
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
    vec3 u = imageLoad(i_increments, texel).xyz;
    vec4 earlier = imageLoad(i_earlier, texel);
    vec4 expected = vec4(u, 1.0);
    vec3 target = u;
    uint holder = (info >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    if (holder != 0u || (info & SRS_FLAG_FIXED) != 0u) {
        expected.w = 0.0;
        target = vec3(0.0);
#if SRS_TOOLS > 0
        if (holder != 0u)
            target = u_moves[holder - 1u].xyz;
#endif
    } else if (earlier.w > 0.0) {
        vec3 change = u - earlier.xyz;
        expected = vec4(u + 0.5 * change, 0.5);
        target = u + change;
    }
    b_connection[i] = info & SRS_CONNECTION_MASK;
    VECTOR(SRS_VEC_G, i) = vec4(0.0);
    VECTOR(SRS_VEC_X, i) = vec4(imageLoad(i_positions, texel).xyz, b_mass[i]);
    VECTOR(SRS_VEC_V, i) = expected;
    VECTOR(SRS_VEC_T, i) = vec4(target, 0.0);
    VECTOR(SRS_VEC_U, i) = vec4(0.0);
    // The search's first direction: free nodes only.
    VECTOR(SRS_VEC_S, i) = expected.w == 0.0 ? vec4(0.0) : vec4(target, 0.0);
}
