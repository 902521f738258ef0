// One step of one texel, whatever the entry point: reads node info, position and increment; computes both anew, and what
// each tool gave. The entry point provides loadPosition and loadIncrement for neighbours, and stores the result.
#include "solver_kernel.glsl"

struct NodeStep {
    vec4 position;  // alpha: packed normal
    vec4 increment;
#if SRS_TOOLS > 0
    vec3 impulse[SRS_TOOLS]; // mass share times lattice units
#endif
};

#if SRS_TOOLS > 0
#include "solver_tools.glsl"
#endif

NodeStep stepNode(ivec2 texel) {
    NodeStep result;
    uvec4 info = imageLoad(i_nodeInfo, texel);
    vec3 x = fetchPosition(texel);
    vec3 u = fetchIncrement(texel);
#if SRS_TOOLS > 0
    for (int tool = 0; tool < SRS_TOOLS; ++tool)
        result.impulse[tool] = vec3(0.0);
#endif
    if ((info.x & SRS_FLAG_ACTIVE) == 0u) {
        result.position = vec4(x, 0.0);
        result.increment = vec4(0.0);
        return result;
    }
    beginAddresses(texel);
    float fills = sumSprings(info, x, u);
    float alpha = 0.0;
#ifdef SRS_NORMALS
    alpha = uintBitsToFloat(packNormal(g_normal));
#endif
    if ((info.x & SRS_FLAG_FIXED) != 0u) {
        result.position = vec4(x, alpha);
        result.increment = vec4(0.0);
        return result;
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
        result.impulse[tool] = (moved - before) * (fills / 2040.0);
    }
    if (moved != free)
        step = moved - x;
#endif
    result.position = vec4(moved, alpha);
    result.increment = vec4(step, 0.0);
    return result;
}
