// Contact, last pass: every node by itself, collider after collider, so that none ends inside. Twin of
// ContactStage::pushNodes. It also empties the lists of the passes over triangles for the next step.
#version 450 core
layout(local_size_x = SRS_GROUP_X, local_size_y = SRS_GROUP_Y) in;
#include "contact_point.glsl"
#include "contact_loads.glsl"
#include "contact_nodes.glsl"
#include "contact_depths.glsl"
#include "contact_work.glsl"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_start;
layout(rgba32f) uniform restrict image2D i_positions;
layout(rgba32f) uniform restrict image2D i_increments;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel == ivec2(0)) {
        b_candidates.groups = b_candidates.count = b_again.groups = 0u;
        for (int i = 0; i < SRS_CONTACT_ITERATIONS; ++i)
            b_movers[i].groups = b_movers[i].count = 0u;
    }
    if (any(greaterThanEqual(texel, imageSize(i_positions))))
        return;
    vec3 x = imageLoad(i_start, texel).xyz;
    vec4 free = imageLoad(i_positions, texel); // alpha: the normal
    vec3 end = free.xyz, moved = vec3(0.0);
    float path = distance(x, end);
    uint info = 0u;
    float mass = 0.0;
    for (int c = 0; c < SRS_COLLIDERS; ++c) {
        if (modeOf(c) != SRS_TOOL_PUSH)
            continue;
        if (isFar(c, end, path, 1.1 * kDeepest))
            continue;
        if (info == 0u) {
            info = imageLoad(i_nodeInfo, texel).x;
            if ((info & SRS_FLAG_ACTIVE) == 0u || (info & SRS_FLAG_FIXED) != 0u)
                return;
            mass = b_node[numberOf(texel)].mass;
        }
        dvec3 y0 = ownAtStart(c, dvec3(x)), y1 = ownAtEnd(c, dvec3(end));
        double own = distance(y0, y1), depth = contactDepthFor(depthOf(info), thinOf(c));
        if (!(sampleShape(c, y1).w - depth < own)) // no part of the way is nearer
            continue;
        dvec3 exact = pointContact(c, y0, y1, depth, sweepSamples(own, thinOf(c)));
        if (exact == dvec3(0.0))
            continue;
        vec3 move = vec3(turned(b_collider[c].turnTo, exact));
        end += move;
        moved += move;
        path = distance(x, end);
        addLoad(c, mass, x, move);
    }
    if (moved == vec3(0.0))
        return;
    imageStore(i_positions, texel, vec4(end, free.w));
    imageStore(i_increments, texel, imageLoad(i_increments, texel) + vec4(moved, 0.0));
}
