#version 450 core
// On which side of the nearest cut each node lies, and how far from it (render/cut_mask.h): after the voxels, which ask for what was
// known before this stroke.
#include "cut_mask_position.glsl"
#include "cut_mask_stroke.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly restrict buffer b_nodes { uint texels[]; }; // y << 16 | x
layout(std430) restrict buffer b_sides { float sides[]; };

uniform int u_nodeCount;

void main() {
    uint node = gl_GlobalInvocationID.x;
    if (node >= uint(u_nodeCount))
        return;
    vec2 d = strokeDistance(nodePosition(texels[node]));
    if (d.x < SRS_MASK_SIDES && d.x < abs(sides[node]))
        sides[node] = d.y;
}
