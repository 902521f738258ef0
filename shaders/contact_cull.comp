// Contact, first pass: lists the boundary triangles that may touch a collider in this step, each with a bit for every
// such collider. Twin of ContactStage::candidates.
#version 450 core
layout(local_size_x = 64) in;
#include "shape_distance.glsl"
#include "contact_texels.glsl"
#include "contact_faces.glsl"
#include "contact_work.glsl"

layout(rgba32f) uniform readonly restrict image2D i_start;     // positions when the step began
layout(rgba32f) uniform readonly restrict image2D i_positions; // and where forces alone take them
layout(std430) writeonly restrict buffer b_candidateList { uvec2 b_candidate[]; }; // triangle, colliders
uniform int u_triangles;

const float kNearBy = 0.25; // spacings: so near, a triangle may touch once others have moved it

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= uint(u_triangles))
        return;
    ContactTriangle triangle = b_triangle[number];
    vec3 x[3], end[3];
    float path = 0.0;
    for (int k = 0; k < 3; ++k) {
        ivec2 texel = texelAt(triangle.nodes[k]);
        x[k] = imageLoad(i_start, texel).xyz;
        end[k] = imageLoad(i_positions, texel).xyz;
        path = max(path, distance(x[k], end[k]));
    }
    float edge = max(distance(end[0], end[1]), distance(end[0], end[2]));
    uint mask = 0u;
    for (int c = 0; c < SRS_COLLIDERS; ++c) {
        if (modeOf(c) != SRS_TOOL_PUSH || shapeOf(c) == SRS_SHAPE_HALF_SPACE)
            continue;
        if (isFar(c, end[0], path + edge, edge + 1.1 * kDeepest + kNearBy))
            continue;
        double own = 0.0;
        for (int k = 0; k < 3; ++k)
            own = max(own, distance(dvec3(end[k]), carried(c, dvec3(x[k]))));
        dvec3 depths = depthsOf(triangle);
        double depth = max(max(depths.x, depths.y), max(depths.z, double(SRS_WALL)));
        if (sampleShape(c, ownAtEnd(c, dvec3(end[0]))).w <= edge + own + depth + kNearBy)
            mask |= 1u << c;
    }
    if (mask == 0u)
        return;
    uint at = atomicAdd(b_candidates.count, 1u);
    b_candidate[at] = uvec2(number, mask);
    atomicMax(b_candidates.groups, at / 64u + 1u);
}
