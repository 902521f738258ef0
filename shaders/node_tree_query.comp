// Answers queries to the tree of sim/node_tree.h, one an invocation. SRS_TREE_QUERY says of which kind:
//   ray        origin and reach; direction -> TreeHit (4 words)
//   closest    point and reach              -> TreeHit
//   in box     lowest; highest corner       -> count, then the indices of triangles whose own boxes overlap it
//   in sphere  centre and radius            -> the same, of triangles whose boxes touch it
#version 450 core
#include "shared_constants.h"
layout(local_size_x = 64) in;

layout(std430) readonly restrict buffer b_queries { vec4 b_query[]; };      // two a query
layout(std430) writeonly restrict buffer b_answers { uint b_answer[]; };
uniform int u_queries;
uniform sampler2D t_positions;

vec3 treePosition(uint texel) { return texelFetch(t_positions, ivec2(texel & 0xffffu, texel >> 16), 0).xyz; }
#include "node_tree_search.glsl"

#if SRS_TREE_QUERY == SRS_TREE_RAY || SRS_TREE_QUERY == SRS_TREE_CLOSEST
void answer(int query) {
    vec4 first = b_query[2 * query];
#if SRS_TREE_QUERY == SRS_TREE_RAY
    TreeHit hit = treeCast(first.xyz, b_query[2 * query + 1].xyz, first.w);
#else
    TreeHit hit = treeClosest(first.xyz, first.w);
#endif
    b_answer[4 * query] = hit.triangle;
    b_answer[4 * query + 1] = floatBitsToUint(hit.weights.x);
    b_answer[4 * query + 2] = floatBitsToUint(hit.weights.y);
    b_answer[4 * query + 3] = floatBitsToUint(hit.distance);
}
#else
void answer(int query) {
    vec4 first = b_query[2 * query], second = b_query[2 * query + 1];
    int slots = query * (1 + SRS_TREE_CANDIDATES), count = 0;
    TreeCursor cursor = treeBegin();
    while (true) {
#if SRS_TREE_QUERY == SRS_TREE_IN_BOX
        int leaf = treeNextInBox(cursor, first.xyz, second.xyz);
#else
        int leaf = treeNextInSphere(cursor, first.xyz, first.w);
#endif
        if (leaf < 0)
            break;
        for (int i = 0; i < SRS_TREE_LEAF; ++i) {
            uvec4 triangle = b_treeTriangle[leaf * SRS_TREE_LEAF + i];
            if (triangle.w == SRS_TREE_NONE)
                break;
            vec3 a = treePosition(triangle.x), b = treePosition(triangle.y), c = treePosition(triangle.z);
            vec3 low = min(a, min(b, c)), high = max(a, max(b, c));
#if SRS_TREE_QUERY == SRS_TREE_IN_BOX
            bool meets = boxesMeet(low, high, first.xyz, second.xyz);
#else
            bool meets = distance2ToBox(first.xyz, low, high) <= first.w * first.w;
#endif
            if (meets && count < SRS_TREE_CANDIDATES)
                b_answer[slots + 1 + count] = triangle.w;
            count += int(meets);
        }
    }
    b_answer[slots] = uint(count);
}
#endif

void main() {
    int query = int(gl_GlobalInvocationID.x);
    if (query < u_queries)
        answer(query);
}
