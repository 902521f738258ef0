// Contact, last pass: every node that is near by itself, collider after collider, so that none ends inside. Twin of
// ContactStage::pushNodes.
#version 450 core
layout(local_size_x = 64) in;
#include "contact_point.glsl"
#include "contact_depths.glsl"
#ifndef SRS_ASKS
#include "contact_loads.glsl"
#endif
#include "contact_nodes.glsl"
#include "contact_work.glsl"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_start;
layout(rgba32f) uniform restrict image2D i_positions;
layout(rgba32f) uniform restrict image2D i_increments;
layout(std430) readonly restrict buffer b_nearList { uvec2 b_near[]; };
#include "contact_ends.glsl"
#ifdef SRS_KEEPS_HELD
#include "contact_kept.glsl"
#endif

void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item >= LIST(SRS_LIST_NEAR).count)
        return;
    uint number = b_near[item].x;
    ivec2 texel = texelAt(number);
    uint info = imageLoad(i_nodeInfo, texel).x;
    if ((info & SRS_FLAG_ACTIVE) == 0u || (info & SRS_FLAG_FIXED) != 0u)
        return;
#ifdef SRS_KEEPS_HELD
    if (kept(info))
        return;
#endif
    vec3 x = imageLoad(i_start, texel).xyz;
    vec4 free = imageLoad(i_positions, texel); // alpha: the normal
    real3 end = endOf(texel);
    vec3 moved = vec3(0.0);
    int mover = 0;
    real rest = depthOf(info);
    float mass = b_node[number].mass;
    for (uint mask = b_near[item].y; mask != 0u; mask &= mask - 1u) {
        int c = findLSB(mask);
        real3 y0 = ownAtStart(c, real3(x)), y1 = ownAtEnd(c, end);
        real path = distance(y0, y1), depth = contactDepthFor(rest, thinOf(c));
        if (!(shapeLowerBound(c, y1) - depth < path)) // no part of the way is nearer
            continue;
        real3 exact = pointContact(c, y0, y1, depth, sweepSamples(path, thinOf(c)));
        if (exact == real3(0.0))
            continue;
        vec3 move = vec3(turned(b_collider[c].turnTo, exact));
#ifdef SRS_ASKS
        end += real3(move);
#else
        end = real3(vec3(end) + move);
        addLoad(c, mass, x, move);
#endif
        moved += move;
        mover = c;
        mask |= SRS_PUSHING & ~((2u << c) - 1u); // it may have come near those that follow
    }
    if (moved == vec3(0.0))
        return;
#ifdef SRS_ASKS
    imageStore(i_increments, texel, vec4(imageLoad(i_increments, texel).xyz + moved, float(mover + 1)));
#else
    imageStore(i_positions, texel, vec4(vec3(end), free.w));
    imageStore(i_increments, texel, imageLoad(i_increments, texel) + vec4(moved, 0.0));
#endif
}
