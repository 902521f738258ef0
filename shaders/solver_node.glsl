// The force pass of one step for one texel, whatever the entry point: reads node info, position and increment; computes
// both anew. Contact, friction and grasps then change the result in place (sim/contact_pass.h). The entry point provides
// loadPosition and loadIncrement for neighbours, and stores the result.
#include "solver_kernel.glsl"

struct NodeStep {
    vec4 position;  // alpha: packed normal
    vec4 increment;
};

NodeStep stepNode(ivec2 texel) {
    NodeStep result;
    uvec4 info = imageLoad(i_nodeInfo, texel);
    vec3 x = fetchPosition(texel);
    vec3 u = fetchIncrement(texel);
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
    result.position = vec4(x + step, alpha);
    result.increment = vec4(step, 0.0);
    return result;
}
