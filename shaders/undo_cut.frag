// Gives back the bits that one stroke cleared (shaders/cut.frag).
#version 450 core
#include "shared_constants.h"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(r32ui) uniform readonly restrict uimage2D i_cleared;

layout(location = 0) out uvec4 o_nodeInfo;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    o_nodeInfo = imageLoad(i_nodeInfo, texel) | uvec4(imageLoad(i_cleared, texel).x & SRS_CONNECTION_MASK, 0u, 0u, 0u);
}
