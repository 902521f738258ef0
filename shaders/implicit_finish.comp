// The last pass of an implicit step: the state textures, with normals (MS05 eq. 3) of where the nodes are now. Twin of
// ImplicitSolver::finish.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "packed_normal.glsl"

layout(std430) readonly buffer b_connections { uint b_connection[]; };
layout(rgba32f) uniform writeonly restrict image2D i_newPositions;
layout(rgba32f) uniform writeonly restrict image2D i_newEarlier;
layout(rgba32f) uniform readonly image2D i_increments; // before the step; may be the same as the new ones
layout(rgba32f) uniform writeonly image2D i_newIncrements;

vec3 endOf(int node) {
    vec4 expected = VECTOR(SRS_VEC_V, node);
    vec3 u = expected.w == 0.0 ? VECTOR(SRS_VEC_T, node).xyz : VECTOR(SRS_VEC_U, node).xyz;
    return VECTOR(SRS_VEC_X, node).xyz + u;
}

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u_nodes)
        return;
    ivec2 texel = texelOf(i);
    vec3 here = endOf(i), normal = vec3(0.0);
    uint bits = b_connection[i];
    for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
        int other = ((bits >> d) & 1u) != 0u ? neighbourOf(i, d) : -1;
        if (other < 0)
            continue;
        vec3 apart = here - endOf(other);
        normal += apart / max(length(apart), 1e-6);
    }
    bool held = isHeld(i);
    vec4 earlier = held ? vec4(0.0) : vec4(imageLoad(i_increments, texel).xyz, 1.0);
#ifdef SRS_CONTACT
    if (!held && VECTOR(SRS_VEC_N, i).w > 0.0)
        earlier = vec4(VECTOR(SRS_VEC_W, i).xyz, VECTOR(SRS_VEC_A, i).w > 0.0 ? -2.0 : -1.0);
#endif
    imageStore(i_newEarlier, texel, earlier);
    imageStore(i_newIncrements, texel, vec4(held ? VECTOR(SRS_VEC_T, i).xyz : VECTOR(SRS_VEC_U, i).xyz, 0.0));
    imageStore(i_newPositions, texel, vec4(here, uintBitsToFloat(packNormal(normal))));
}
