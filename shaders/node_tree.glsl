// Walks the tree of sim/node_tree.h: boxes over a lattice's boundary triangles. The tree is implicit: level 0 holds the
// leaves, the nodes below node i of a level are i * SRS_TREE_WIDTH and the next ones of the level under it. So the walk
// needs no stack: from a node it goes to the first one below, or to the next one outside of its branch. Levels are padded
// with boxes that are empty.
//
// A pass asks for leaf after leaf, and looks at their triangles:
//     TreeCursor cursor = treeBegin();
//     for (int leaf = treeNextInBox(cursor, low, high); leaf >= 0; leaf = treeNextInBox(cursor, low, high))
//         for (int i = 0; i < SRS_TREE_LEAF; ++i) {
//             uvec4 triangle = b_treeTriangle[leaf * SRS_TREE_LEAF + i];
//             if (triangle.w != SRS_TREE_NONE) ...
//         }
// NodeTree::bind sets what stands here. node_tree_search.glsl has the usual searches.
#include "shared_constants.h"

layout(std430) readonly restrict buffer b_treeBoxes { vec4 b_treeBox[]; };           // lowest, highest corner of each
layout(std430) readonly restrict buffer b_treeTriangles { uvec4 b_treeTriangle[]; }; // texels of its three nodes
                                                    // (y << 16 | x); its index; SRS_TREE_NONE: none
uniform int u_treeStarts[SRS_TREE_MOST_LEVELS]; // first box of each level
uniform ivec2 u_treeTop;                        // uppermost level, and how many nodes it has

struct TreeCursor {
    int level, node;
};

TreeCursor treeBegin() { return TreeCursor(u_treeTop.x, 0); }
bool treeDone(TreeCursor at) { return at.level == u_treeTop.x && at.node >= u_treeTop.y; }
int treeBox(TreeCursor at) { return 2 * (u_treeStarts[at.level] + at.node); }

/// To the next node outside of this one's branch.
void treeSkip(inout TreeCursor at) {
    ++at.node;
    while (at.level < u_treeTop.x && (at.node & (SRS_TREE_WIDTH - 1)) == 0) {
        at.node >>= SRS_TREE_LOG2_WIDTH;
        ++at.level;
    }
}

// The next leaf whose box [low, high] meets `test`, -1: none is left.
#define TREE_NEXT(test)                                                                                                \
    while (!treeDone(at)) {                                                                                            \
        int box = treeBox(at);                                                                                         \
        vec3 low = b_treeBox[box].xyz, high = b_treeBox[box + 1].xyz;                                                  \
        bool meets = low.x <= high.x && (test);                                                                        \
        if (meets && at.level > 0) {                                                                                   \
            --at.level;                                                                                                \
            at.node <<= SRS_TREE_LOG2_WIDTH;                                                                           \
        } else {                                                                                                       \
            int leaf = at.node;                                                                                        \
            treeSkip(at);                                                                                              \
            if (meets)                                                                                                 \
                return leaf;                                                                                           \
        }                                                                                                              \
    }                                                                                                                  \
    return -1;

bool boxesMeet(vec3 low, vec3 high, vec3 low2, vec3 high2) {
    return all(lessThanEqual(low, high2)) && all(greaterThanEqual(high, low2));
}
int treeNextInBox(inout TreeCursor at, vec3 from, vec3 to) { TREE_NEXT(boxesMeet(low, high, from, to)) }

float distance2ToBox(vec3 p, vec3 low, vec3 high) {
    vec3 away = max(max(low - p, p - high), vec3(0.0));
    return dot(away, away);
}
/// Touching counts.
int treeNextInSphere(inout TreeCursor at, vec3 centre, float radius) {
    TREE_NEXT(distance2ToBox(centre, low, high) <= radius * radius)
}

struct TreeRay {
    vec3 origin, direction;
    vec3 inverse; // of the direction; large where that is 0
};
TreeRay makeTreeRay(vec3 origin, vec3 direction) {
    vec3 least = vec3(1e-30); // 0 * inverse stays 0
    vec3 safe = mix(direction, least, lessThan(abs(direction), least));
    return TreeRay(origin, direction, 1.0 / safe);
}
bool rayMeetsBox(TreeRay ray, float reach, vec3 low, vec3 high) {
    vec3 a = (low - ray.origin) * ray.inverse, b = (high - ray.origin) * ray.inverse;
    vec3 near = min(a, b), far = max(a, b);
    float enter = max(max(near.x, near.y), max(near.z, 0.0)), leave = min(min(far.x, far.y), min(far.z, reach));
    return enter <= leave + 1e-6 * (abs(enter) + abs(leave)); // slack for rounding
}
int treeNextOnRay(inout TreeCursor at, TreeRay ray, float reach) {
    TREE_NEXT(rayMeetsBox(ray, reach, low, high))
}
