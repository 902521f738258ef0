// One solver step as a fragment pass over the state textures (MS05 3.1): reads positions, increments and node info,
// writes positions (alpha: packed normal) and increments.
#version 450 core
#include "shared_constants.h"
#include "solver_state.glsl"
vec3 loadPosition(ivec2 texel) { return fetchPosition(texel); }
vec3 loadIncrement(ivec2 texel) { return fetchIncrement(texel); }
#include "solver_node.glsl"

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_increment;

void main() {
    NodeStep result = stepNode(ivec2(gl_FragCoord.xy));
    o_position = result.position;
    o_increment = result.increment;
}
