// One solver step as a fragment pass over the state textures (MS05 3.1): reads positions, increments and node info,
// writes positions (alpha: packed normal), increments, and adds each tool's impulse by blending.
#version 450 core
#include "shared_constants.h"
#include "solver_state.glsl"
vec3 loadPosition(ivec2 texel) { return fetchPosition(texel); }
vec3 loadIncrement(ivec2 texel) { return fetchIncrement(texel); }
#include "solver_node.glsl"

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_increment;
#if SRS_TOOLS > 0
layout(location = 2) out vec4 o_impulse[SRS_TOOLS]; // mass share times lattice units, summed over the frame
#endif

void main() {
    NodeStep result = stepNode(ivec2(gl_FragCoord.xy));
    o_position = result.position;
    o_increment = result.increment;
#if SRS_TOOLS > 0
    for (int tool = 0; tool < SRS_TOOLS; ++tool)
        o_impulse[tool] = vec4(result.impulse[tool], 0.0);
#endif
}
