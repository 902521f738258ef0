// The grasp pass of the fragment solver.
#version 450 core
#include "grasp.glsl"

layout(location = 0) out uvec4 o_nodeInfo;

void main() { o_nodeInfo = infoAfterGrasp(ivec2(gl_FragCoord.xy)); }
