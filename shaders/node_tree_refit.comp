// One level of the boxes of sim/node_tree.h from the positions as they are: leaves hold their triangles, nodes the boxes
// below them. Minima and maxima are exact: no box needs a margin.
#version 450 core
#include "shared_constants.h"
layout(local_size_x = 64) in;

layout(std430) restrict buffer b_treeBoxes { vec4 b_treeBox[]; };
layout(std430) readonly restrict buffer b_treeTriangles { uvec4 b_treeTriangle[]; };
uniform int u_start;      // first box of the level
uniform int u_startBelow; // of the one under it, -1: these are leaves
uniform int u_count;      // nodes of the level
uniform sampler2D t_positions;
uniform sampler2D t_increments;
uniform float u_sweep; // steps back: boxes hold the way from x - sweep u to x

vec3 g_low, g_high;

void addNode(uint texel) {
    ivec2 at = ivec2(texel & 0xffffu, texel >> 16);
    vec3 x = texelFetch(t_positions, at, 0).xyz;
    g_low = min(g_low, x);
    g_high = max(g_high, x);
    if (u_sweep != 0.0) {
        vec3 before = x - u_sweep * texelFetch(t_increments, at, 0).xyz;
        g_low = min(g_low, before);
        g_high = max(g_high, before);
    }
}
void addTriangle(int index) {
    uvec4 triangle = b_treeTriangle[index];
    if (triangle.w == SRS_TREE_NONE)
        return;
    addNode(triangle.x);
    addNode(triangle.y);
    addNode(triangle.z);
}
void addBox(int index) {
    g_low = min(g_low, b_treeBox[2 * index].xyz);
    g_high = max(g_high, b_treeBox[2 * index + 1].xyz);
}

void main() {
    int node = int(gl_GlobalInvocationID.x);
    if (node >= u_count)
        return;
    g_low = vec3(1e30);
    g_high = vec3(-1e30);
    if (u_startBelow < 0) {
        int first = node * SRS_TREE_LEAF;
        addTriangle(first);
        addTriangle(first + 1);
        addTriangle(first + 2);
        addTriangle(first + 3);
    } else {
        int first = u_startBelow + node * SRS_TREE_WIDTH;
        addBox(first);
        addBox(first + 1);
        addBox(first + 2);
        addBox(first + 3);
        addBox(first + 4);
        addBox(first + 5);
        addBox(first + 6);
        addBox(first + 7);
    }
    b_treeBox[2 * (u_start + node)] = vec4(g_low, 0.0);
    b_treeBox[2 * (u_start + node) + 1] = vec4(g_high, 0.0);
}
