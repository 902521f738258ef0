// Takes hold of the nodes inside a grasping sphere, or lets them go: twin of updateHeldNodes in sim/tool_motion.cpp,
// shared by the fragment and the compute pass that rewrite the node info texture.
#include "shared_constants.h"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_positions;
uniform vec4 u_sphere; // centre and radius, lattice units
uniform uint u_holder; // 1 + tool index
uniform int u_closes;  // 1: takes hold, 0: lets go

uvec4 infoAfterGrasp(ivec2 texel) {
    uvec4 info = imageLoad(i_nodeInfo, texel);
    uint holder = (info.x >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    if (u_closes == 0) {
        if (holder == u_holder)
            holder = 0u;
    } else if (holder == 0u && (info.x & SRS_FLAG_ACTIVE) != 0u && (info.x & SRS_FLAG_FIXED) == 0u &&
               distance(imageLoad(i_positions, texel).xyz, u_sphere.xyz) < u_sphere.w) {
        holder = u_holder;
    }
    info.x = (info.x & ~(SRS_HELD_MASK << SRS_HELD_SHIFT)) | (holder << SRS_HELD_SHIFT);
    return info;
}
