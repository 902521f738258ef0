// Contact and grasp of one step: twin of ToolMotion::apply in sim/tool_motion.cpp. SRS_TOOLS is the number of tools.
#include "shared_constants.h"

uniform vec4 u_toolSpheres[SRS_MAX_TOOLS]; // centre at the end of the step and radius, lattice units
uniform vec4 u_toolMoves[SRS_MAX_TOOLS];   // motion of the centre in this step, lattice units; w: SRS_TOOL_...

/// Position after the step of a node that was at `x` and moves freely to `free`; `depth` below the organ's surface at
/// rest, -2 to 1 spacings (sim/node_depths.h).
vec3 applyTool(int tool, uint holder, float depth, vec3 x, vec3 free) {
    int mode = int(u_toolMoves[tool].w);
    if (mode == SRS_TOOL_GRASP)
        return holder == uint(tool + 1) ? x + u_toolMoves[tool].xyz : free;
    vec3 away = free - u_toolSpheres[tool].xyz;
    float distance2 = dot(away, away);
    vec3 start = x - (u_toolSpheres[tool].xyz - u_toolMoves[tool].xyz);
    float start2 = dot(start, start);
    float radius = min(max(u_toolSpheres[tool].w + depth, 0.0), sqrt(start2) + SRS_EJECTION);
    if (mode != SRS_TOOL_PUSH || !(distance2 < radius * radius)) // what is no number stays so
        return free;
    vec3 normal = start2 > 1e-12 ? start * inversesqrt(start2) : vec3(0.0, 1.0, 0.0);
    float along = dot(away, normal);
    return free + normal * (sqrt(max(radius * radius - max(distance2 - along * along, 0.0), 0.0)) - along);
}
