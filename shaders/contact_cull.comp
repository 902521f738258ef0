// Contact, first passes: lists the boundary triangles that a collider may touch in this step, each with a bit for every
// such collider. Twin of ContactStage::candidates; lists no fewer.
#version 450 core
#define SRS_SINGLE
layout(local_size_x = 64) in;
#include "shape_distance.glsl"
#include "contact_faces.glsl"
#include "contact_texels.glsl"
#include "contact_work.glsl"

layout(rgba32f) uniform readonly restrict image2D i_start;
layout(rgba32f) uniform readonly restrict image2D i_positions;
layout(std430) writeonly restrict buffer b_candidateList { uvec2 b_candidate[]; }; // triangle, colliders
uniform int u_triangles;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= uint(u_triangles))
        return;
    ContactTriangle triangle = b_triangle[number];
    vec3 end[3];
    float path = 0.0;
    for (int k = 0; k < 3; ++k) {
        ivec2 texel = texelAt(triangle.nodes[k]);
        end[k] = imageLoad(i_positions, texel).xyz;
        path = max(path, distance(imageLoad(i_start, texel).xyz, end[k]));
    }
    float edge = max(distance(end[0], end[1]), distance(end[0], end[2]));
    uint mask = 0u;
    for (int c = 0; c < SRS_COLLIDERS; ++c) {
        float reach = edge + kDeepest + kNearBy + relativePath(c, end[0], path + edge);
        if (modeOf(c) == SRS_TOOL_PUSH && shapeOf(c) != SRS_SHAPE_HALF_SPACE &&
            shapeLowerBound(c, ownAtEnd(c, end[0])) <= reach)
            mask |= 1u << c;
    }
    if (mask != 0u)
        b_candidate[appendTo(SRS_LIST_CANDIDATES)] = uvec2(number, mask);
}
