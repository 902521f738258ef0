// Hands a lattice's motion to another level of detail: each node's displacement and increment from those of the other
// lattice's, by the rows of sim/lod_map.h. Twin: transferState in sim/lod.cpp, which says what is done and why.
#version 450 core
#include "lod.glsl"
layout(local_size_x = 64) in;

layout(std430) readonly restrict buffer b_targets { uvec4 b_target[]; }; // two a node: rest position, texel; first and
                                                     // last row entry of its place, of its velocity
layout(std430) readonly restrict buffer b_detail { vec4 b_fineDetail[]; }; // one a target node
uniform int u_nodes;
uniform float u_lengthScale, u_velocityScale;
uniform float u_lead;   // of the increments before the last, beta
uniform bool u_detailed; // to finer, and there is detail
uniform sampler2D t_positions, t_increments, t_before;
layout(rgba32f) uniform writeonly restrict image2D i_newPositions;
layout(rgba32f) uniform writeonly restrict image2D i_newIncrements;

vec3 incrementAt(ivec2 texel) {
    vec3 u = texelFetch(t_increments, texel, 0).xyz;
    return u_lead == 0.0 ? u : u + u_lead * (u - texelFetch(t_before, texel, 0).xyz);
}

void main() {
    int node = int(gl_GlobalInvocationID.x);
    if (node >= u_nodes)
        return;
    uvec4 target = b_target[2 * node], rows = b_target[2 * node + 1];
    vec3 x = uintBitsToFloat(target.xyz), u = vec3(0.0);
    bool fixedNode = (target.w & SRS_LOD_FIXED) != 0u;
    if (!fixedNode) {
        vec3 moved = vec3(0.0);
        for (uint i = rows.x; i < rows.y; ++i) {
            uvec4 source = b_source[b_entry[i].x];
            moved += uintBitsToFloat(b_entry[i].y) *
                     (texelFetch(t_positions, lodTexel(source.w), 0).xyz - uintBitsToFloat(source.xyz));
        }
        x += u_lengthScale * moved;
        if (u_detailed)
            x += lodFrame(rows.x, t_positions) * b_fineDetail[node].xyz;
        for (uint i = rows.z; i < rows.w; ++i)
            u += uintBitsToFloat(b_entry[i].y) * incrementAt(lodTexel(b_source[b_entry[i].x].w));
        u *= u_velocityScale;
    }
    imageStore(i_newPositions, lodTexel(target.w), vec4(x, 0.0));
    imageStore(i_newIncrements, lodTexel(target.w), vec4(u, 0.0));
}
