// What each tool and body gave to the nodes that it holds or touches: the gradient of Phi there at the end of a step, without
// what gives it. Twin of ImplicitContact::finish.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "contact_colliders.glsl"
#include "contact_loads.glsl"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_increments; // before the step

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u_nodes)
        return;
    ivec2 texel = texelOf(i);
    uint holder = (imageLoad(i_nodeInfo, texel).x >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    vec4 x = VECTOR(SRS_VEC_X, i), force = VECTOR(SRS_VEC_F, i);
    vec3 impulse = VECTOR(SRS_VEC_G, i).xyz + force.xyz;
    if (VECTOR(SRS_VEC_N, i).w > 0.0) {
        if (VECTOR(SRS_VEC_V, i).w < 1.0) // Houbolt's: from here on momentum is counted otherwise
            impulse += x.w * (imageLoad(i_increments, texel).xyz - VECTOR(SRS_VEC_U, i).xyz);
        addLoad(int(force.w) - 1, 1.0, x.xyz, impulse);
    } else if (holder != 0u) {
        addLoad(int(holder) - 1, 1.0, x.xyz, impulse);
    }
}
