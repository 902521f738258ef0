// Contact, a round's first pass: what each triangle that touches a collider asks of its corners, the largest of all
// colliders for each corner. Twin of ContactStage::ask.
#version 450 core
layout(local_size_x = 64) in;
#include "contact_shares.glsl"
#include "contact_triangle.glsl"
#include "contact_texels.glsl"
#include "contact_faces.glsl"
#include "contact_work.glsl"

layout(rgba32f) uniform readonly restrict image2D i_start;
layout(rgba32f) uniform readonly restrict image2D i_positions;
layout(rgba32f) uniform readonly restrict image2D i_increments;
#include "contact_ends.glsl"
#ifdef SRS_KEEPS_HELD
layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
#include "contact_kept.glsl"
#endif
layout(std430) readonly restrict buffer b_candidateList { uvec2 b_candidate[]; };
layout(std430) writeonly restrict buffer b_asks { uvec4 b_ask[]; }; // triangle * 3 + corner: move; stamp, collider
layout(std430) restrict buffer b_marks { uint b_mark[]; };          // by node: the last round that moved it
layout(std430) writeonly restrict buffer b_moverList { uint b_mover[]; };
uniform int u_round;  // 0, 1, ...
uniform uint u_stamp; // of step and round, below 2^28, never 0

void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item >= LIST(SRS_LIST_CANDIDATES).count)
        return;
    uvec2 candidate = b_candidate[item];
    ContactTriangle triangle = b_triangle[candidate.x];
    dvec3 depths = depthsOf(triangle), inverseMasses;
    dvec3 start[3], end[3];
    vec3 moves[3] = vec3[3](vec3(0.0), vec3(0.0), vec3(0.0));
    int movers[3] = int[3](0, 0, 0);
    for (int k = 0; k < 3; ++k) {
        start[k] = dvec3(imageLoad(i_start, texelAt(triangle.nodes[k])).xyz);
        end[k] = endOf(texelAt(triangle.nodes[k]));
        inverseMasses[k] = triangle.inverseMasses[k];
#ifdef SRS_KEEPS_HELD
        if (kept(imageLoad(i_nodeInfo, texelAt(triangle.nodes[k])).x))
            inverseMasses[k] = 0.0lf;
#endif
    }
    for (uint mask = candidate.y; mask != 0u; mask &= mask - 1u) {
        int c = findLSB(mask);
        dvec3 weights;
        dvec3 depth = max(depths, dvec3(-0.5lf * thinOf(c)));
        dvec3 move = triangleContact(
            c, Corners(ownAtStart(c, start[0]), ownAtStart(c, start[1]), ownAtStart(c, start[2])),
            Corners(ownAtEnd(c, end[0]), ownAtEnd(c, end[1]), ownAtEnd(c, end[2])), depth, weights);
        if (move == dvec3(0.0))
            continue;
        dvec3 shares = cornerShares(weights, inverseMasses); // 0 where all are fixed
        move = turned(b_collider[c].turnTo, move);
        for (int k = 0; k < 3; ++k) {
            vec3 asked = vec3(move * shares[k]);
            if (dot(asked, asked) > dot(moves[k], moves[k])) {
                moves[k] = asked;
                movers[k] = c;
            }
        }
    }
    bool any = false;
    for (int k = 0; k < 3; ++k) {
        if (moves[k] == vec3(0.0))
            continue;
        any = true;
        b_ask[candidate.x * 3u + uint(k)] = uvec4(floatBitsToUint(moves[k]), u_stamp << 4 | uint(movers[k]));
        if (atomicExchange(b_mark[triangle.nodes[k]], u_stamp) != u_stamp) {
            b_mover[appendTo(SRS_LIST_MOVERS + u_round)] = triangle.nodes[k];
        }
    }
    if (any && u_round == 0)
        atomicMax(LIST(SRS_LIST_AGAIN).groups, gl_NumWorkGroups.x);
}
