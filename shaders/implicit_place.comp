// Before each of Newton's rounds, first pass: what contact gave after the last round's step, and where it shall be asked
// (the asking passes of sim/contact_pass.h) where it would move nodes: at their increments, less the pressure over the
// penalty's stiffness. Twin of ImplicitContact::takeGiven.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_symmetric.glsl"

layout(rgba32f) uniform writeonly restrict image2D i_newPositions;
layout(rgba32f) uniform writeonly restrict image2D i_newIncrements;
uniform int u_round; // 0 .. rounds; the last has none to follow

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u_nodes)
        return;
    vec4 normal = VECTOR(SRS_VEC_N, i), gave = VECTOR(SRS_VEC_W, i);
    vec3 offset = vec3(0.0);
    if (normal.w > 0.0 && u_round == 0) {
        offset = gave.xyz / -gave.w;
    } else if (normal.w > 0.0) {
        vec4 stiff = VECTOR(SRS_VEC_KA, i);
        gave.xyz = VECTOR(SRS_VEC_F, i).xyz -
                   times(Symmetric(stiff.xyz, VECTOR(SRS_VEC_KB, i).xyz), VECTOR(SRS_VEC_S, i).xyz);
        stiff.w = max(0.0, dot(gave.xyz, normal.xyz));
        offset = normal.xyz * (-stiff.w / gave.w);
        VECTOR(SRS_VEC_W, i) = gave;
        VECTOR(SRS_VEC_KA, i) = stiff;
    }
    vec3 way = VECTOR(SRS_VEC_U, i).xyz + offset;
    VECTOR(SRS_VEC_Z, i) = vec4(way, 0.0);
    ivec2 texel = texelOf(i);
    imageStore(i_newPositions, texel, vec4(VECTOR(SRS_VEC_X, i).xyz + way, 0.0));
    imageStore(i_newIncrements, texel, vec4(way, 0.0));
}
