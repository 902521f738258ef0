// One node of the multilevel preconditioner (ImplicitSystem::precondition): down to a coarser level, and up again.
#include "implicit_symmetric.glsl"
layout(std430) coherent buffer b_levels { vec4 b_level[]; }; // SRS_LEVEL_VECTORS

vec3 residualOf(int level, int node) {
    return level == 0 ? VECTOR(SRS_VEC_R, node).xyz : b_level[levelInt(level, SRS_LEVEL_VECTORS) + node].xyz;
}

void restrictTo(int level, int node) {
    vec3 sum = vec3(0.0);
    for (int place = 0; place < 27; ++place) {
        int finer = finerOf(level, node, place);
        if (finer >= 0)
            sum += finerWeight(place) * residualOf(level - 1, finer);
    }
    b_level[levelInt(level, SRS_LEVEL_VECTORS) + node] = vec4(sum, 0.0);
}

/// What the next level's correction is at a node.
vec3 fromCoarser(int level, int node) {
    int at = levelInt(level + 1, SRS_LEVEL_VECTORS) + levelInt(level + 1, SRS_LEVEL_NODES);
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int k = 0; k < 8; ++k) {
        int coarser = coarserOf(level, node, k);
        if (coarser < 0)
            break;
        sum += b_level[at + coarser].xyz;
        count += 1.0;
    }
    return sum / count;
}

void prolongTo(int level, int node) { // level > 0
    int at = levelInt(level, SRS_LEVEL_VECTORS), nodes = levelInt(level, SRS_LEVEL_NODES);
    Symmetric inverse = Symmetric(b_level[at + 2 * nodes + node].xyz, b_level[at + 3 * nodes + node].xyz);
    b_level[at + nodes + node] = vec4(times(inverse, residualOf(level, node)) + fromCoarser(level, node), 0.0);
}
