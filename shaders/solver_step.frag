// One solver step as a fragment pass over the state textures (MS05 3.1): reads positions, increments and node info,
// writes positions (alpha: packed normal), increments, and adds each tool's impulse by blending.
#version 450 core
#include "shared_constants.h"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
#ifdef SRS_TEXEL_FETCH
uniform sampler2D t_positions;
uniform sampler2D t_increments;
vec3 loadPosition(ivec2 texel) { return texelFetch(t_positions, texel, 0).xyz; }
vec3 loadIncrement(ivec2 texel) { return texelFetch(t_increments, texel, 0).xyz; }
#else
layout(rgba32f) uniform readonly restrict image2D i_positions;
layout(rgba32f) uniform readonly restrict image2D i_increments;
vec3 loadPosition(ivec2 texel) { return imageLoad(i_positions, texel).xyz; }
vec3 loadIncrement(ivec2 texel) { return imageLoad(i_increments, texel).xyz; }
#endif

#include "solver_kernel.glsl"

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_increment;
#if SRS_TOOLS > 0
#include "solver_tools.glsl"
layout(location = 2) out vec4 o_impulse[SRS_TOOLS]; // mass share times lattice units, summed over the frame
#endif

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    uvec4 info = imageLoad(i_nodeInfo, texel);
    vec3 x = loadPosition(texel);
    vec3 u = loadIncrement(texel);
#if SRS_TOOLS > 0
    for (int tool = 0; tool < SRS_TOOLS; ++tool)
        o_impulse[tool] = vec4(0.0);
#endif
    if ((info.x & SRS_FLAG_ACTIVE) == 0u) {
        o_position = vec4(x, 0.0);
        o_increment = vec4(0.0);
        return;
    }
    beginAddresses(texel);
    float fills = sumSprings(info, x, u);
    float alpha = 0.0;
#ifdef SRS_NORMALS
    alpha = uintBitsToFloat(packNormal(g_normal));
#endif
    if ((info.x & SRS_FLAG_FIXED) != 0u) {
        o_position = vec4(x, alpha);
        o_increment = vec4(0.0);
        return;
    }
    // F/m = (g_force / 1020) / (fills / 2040)
    vec3 step = u_drag * u + (u_acceleration * 2.0 / fills) * g_force + u_gravity;
    vec3 moved = x + step;
#if SRS_TOOLS > 0
    vec3 free = moved;
    uint holder = (info.x >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    float depth = float((info.x >> SRS_DEPTH_SHIFT) & SRS_DEPTH_MASK) * (1.0 / 85.0) - 2.0;
    for (int tool = 0; tool < SRS_TOOLS; ++tool) {
        vec3 before = moved;
        moved = applyTool(tool, holder, depth, x, moved);
        o_impulse[tool] = vec4((moved - before) * (fills / 2040.0), 0.0);
    }
    if (moved != free)
        step = moved - x;
#endif
    o_position = vec4(moved, alpha);
    o_increment = vec4(step, 0.0);
}
