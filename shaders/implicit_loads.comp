// What each tool gave to the nodes that it holds: the gradient of Phi there at the end of a step, added to one sum a work
// group and tool.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(std430) buffer b_impulses { vec4 b_impulse[]; }; // group * SRS_TOOLS + tool

void main() {
    int i = int(gl_GlobalInvocationID.x);
    uint holder = 0u;
    if (i < u_nodes)
        holder = (imageLoad(i_nodeInfo, texelOf(i)).x >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    for (int tool = 0; tool < SRS_TOOLS; ++tool) {
        vec4 given = sumOfGroup(int(holder) == tool + 1 ? VECTOR(SRS_VEC_G, i) : vec4(0.0));
        if (gl_LocalInvocationID.x == 0u)
            b_impulse[int(gl_WorkGroupID.x) * SRS_TOOLS + tool] += given;
    }
}
