// What finite grips hold and did not let slip goes just where it is carried; what slipped out is let go. In place, after the
// last push. Twin of the end of ImplicitContact::finish.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "shape_distance.glsl"
#include "contact_loads.glsl"

layout(rgba32ui) uniform restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform restrict image2D i_positions;
layout(rgba32f) uniform restrict image2D i_increments;

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u_nodes)
        return;
    ivec2 texel = texelOf(i);
    uvec4 info = imageLoad(i_nodeInfo, texel);
    uint holder = (info.x >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    if (holder == 0u || holdsEndlessly(int(holder) - 1))
        return;
    int c = int(holder) - 1;
    vec4 x = VECTOR(SRS_VEC_X, i), end = imageLoad(i_positions, texel);
    vec3 u = imageLoad(i_increments, texel).xyz;
    if (VECTOR(SRS_VEC_A, i).w == 0.0) { // what the penalty left
        vec3 way = vec3(carried(c, real3(x.xyz)) - real3(x.xyz));
        addLoad(c, x.w, x.xyz, way - u);
        u = way;
        imageStore(i_increments, texel, vec4(u, 0.0));
        imageStore(i_positions, texel, vec4(x.xyz + u, end.w));
    }
    if (sampleShape(c, ownAtEnd(c, real3(x.xyz) + real3(u))).w > SRS_GRIP_SLACK) {
        info.x &= ~(SRS_HELD_MASK << SRS_HELD_SHIFT);
        imageStore(i_nodeInfo, texel, info);
    }
}
