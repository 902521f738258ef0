// Contact, a round's second pass: each node that triangles ask to move goes, triangle after triangle, as far along each
// of these moves as it does not yet. Twin of ContactStage::pushTriangles.
#version 450 core
layout(local_size_x = 64) in;
#include "contact_colliders.glsl"
#ifndef SRS_ASKS
#include "contact_loads.glsl"
#endif
#include "contact_nodes.glsl"
#include "contact_work.glsl"

layout(rgba32f) uniform readonly restrict image2D i_start;
layout(rgba32f) uniform restrict image2D i_positions;
layout(rgba32f) uniform restrict image2D i_increments;
layout(std430) readonly restrict buffer b_corners { uint b_corner[]; }; // triangle * 3 + corner, node by node
layout(std430) readonly restrict buffer b_asks { uvec4 b_ask[]; };
layout(std430) readonly restrict buffer b_moverList { uint b_mover[]; };
layout(std430) writeonly restrict buffer b_nearList { uvec2 b_near[]; };
layout(std430) restrict buffer b_listed { uint b_listedIn[]; };
uniform int u_round;
uniform uint u_stamp;
uniform uint u_step;

void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item >= LIST(SRS_LIST_MOVERS + u_round).count)
        return;
    uint number = b_mover[item], mover = 0u;
    ContactNode node = b_node[number];
    ivec2 texel = texelAt(number);
    vec3 start = imageLoad(i_start, texel).xyz, move = vec3(0.0);
    for (uint i = node.firstCorner; i < node.firstCorner + node.corners; ++i) {
        uvec4 ask = b_ask[b_corner[i]];
        if (ask.w >> 4 != u_stamp)
            continue;
        vec3 asked = uintBitsToFloat(ask.xyz);
        float length2 = dot(asked, asked), lacks = length2 - dot(move, asked);
        if (!(lacks > 0.0))
            continue;
        vec3 more = asked * (lacks / length2);
        move += more;
        mover = ask.w & 15u;
#ifndef SRS_ASKS
        addLoad(int(mover), node.mass, start, more);
#endif
    }
#ifdef SRS_ASKS
    imageStore(i_increments, texel, vec4(imageLoad(i_increments, texel).xyz + move, float(mover + 1u)));
#else
    imageStore(i_positions, texel, imageLoad(i_positions, texel) + vec4(move, 0.0));
    imageStore(i_increments, texel, imageLoad(i_increments, texel) + vec4(move, 0.0));
#endif
    if (atomicExchange(b_listedIn[number], u_step) != u_step) // it may have come near a collider now
        b_near[appendTo(SRS_LIST_NEAR)] = uvec2(number, SRS_PUSHING);
}
