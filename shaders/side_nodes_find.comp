// First pass of render/side_nodes.h: on which side of a cut each node is. One in the blade's very way goes with those that its springs
// still hold it to, whatever the rounded distance says; held to neither side, it is of none (SRS_SIDE_LOOSE).
#version 450 core
#include "side_nodes.glsl"
layout(local_size_x = 64) in;

layout(std430) restrict writeonly buffer b_found { float b_foundSide[]; };

float foundSide(int node) {
    float side = b_side[node];
    if (abs(side) >= SRS_SIDE_ON)
        return side;
    vec2 before = vec2(0.0), left = vec2(0.0); // springs to nodes that are surely above, below
    uint rest = b_node[node].z, now = connectionsOf(node);
    for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
        int other = (rest >> d & 1u) != 0u ? nodeAt(gridOf(node) + offset(d)) : -1;
        if (other < 0 || isFar(other) || abs(b_side[other]) < SRS_SIDE_ON)
            continue;
        vec2 which = b_side[other] > 0.0 ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
        before += which;
        left += float(now >> d & 1u) * which;
    }
    if (left == vec2(0.0) && before.x > 0.0 && before.y > 0.0)
        return SRS_SIDE_LOOSE;
    vec2 lost = (before - left) / max(before, 1.0);
    float near = max(abs(side), 1e-6);
    return lost.x < lost.y ? near : lost.x > lost.y ? -near : side >= 0.0 ? near : -near;
}

void main() {
    int node = int(gl_GlobalInvocationID.x);
    if (node < u_nodeCount)
        b_foundSide[node] = foundSide(node);
}
