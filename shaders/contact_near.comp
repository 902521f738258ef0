// Contact, first passes: lists the nodes that a collider may touch in this step, each with a bit for every such collider.
// Also empties the lists of the step before.
#version 450 core
#define SRS_SINGLE
layout(local_size_x = SRS_GROUP_X, local_size_y = SRS_GROUP_Y) in;
#include "shape_distance.glsl"
#include "contact_depths.glsl"
#include "contact_texels.glsl"
#include "contact_work.glsl"

layout(rgba32f) uniform readonly restrict image2D i_start;     // positions when the step began
layout(rgba32f) uniform readonly restrict image2D i_positions; // and where forces alone take them
layout(std430) writeonly restrict buffer b_nearList { uvec2 b_near[]; }; // node, colliders
layout(std430) writeonly restrict buffer b_listed { uint b_listedIn[]; }; // by node: the last step that listed it
uniform uint u_step; // its number below 2^26, never 0

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel == ivec2(0)) {
        int first = (1 - u_set) * SRS_CONTACT_LISTS;
        for (int i = first; i < first + SRS_CONTACT_LISTS; ++i)
            b_list[i].groups = b_list[i].count = 0u;
    }
    if (any(greaterThanEqual(texel, imageSize(i_positions))))
        return;
    vec3 end = imageLoad(i_positions, texel).xyz;
    float path = distance(imageLoad(i_start, texel).xyz, end);
    uint mask = 0u;
    for (int c = 0; c < SRS_COLLIDERS; ++c) {
        float reach = kDeepest + kNearBy + relativePath(c, end, path);
        if (modeOf(c) == SRS_TOOL_PUSH && shapeLowerBound(c, ownAtEnd(c, end)) <= reach)
            mask |= 1u << c;
    }
    if (mask == 0u)
        return;
    b_near[appendTo(SRS_LIST_NEAR)] = uvec2(numberOf(texel), mask);
    b_listedIn[numberOf(texel)] = u_step;
}
