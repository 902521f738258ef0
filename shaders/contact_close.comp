// Grasps that open or close at this step's start: who is held is rewritten in place, twin of ContactStage::updateHeld.
// Lists those who are, and counts the mass that each tool holds, which contact_held.comp then keeps up to date.
#version 450 core
layout(local_size_x = SRS_GROUP_X, local_size_y = SRS_GROUP_Y) in;
#include "shape_distance.glsl"
#include "contact_nodes.glsl"
#include "contact_grasp.glsl"

uniform uint u_opens;  // a bit a tool
uniform uint u_closes; // the same

layout(rgba32ui) uniform restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_start;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(i_nodeInfo))))
        return;
    uvec4 info = imageLoad(i_nodeInfo, texel);
    if ((info.x & SRS_FLAG_ACTIVE) == 0u)
        return;
    uint before = (info.x >> SRS_HELD_SHIFT) & SRS_HELD_MASK, holder = before;
    for (int c = 0; c < SRS_TOOLS; ++c) {
        if (holder == uint(c + 1) && ((u_opens >> c) & 1u) != 0u)
            holder = 0u;
        if (holder == 0u && ((u_closes >> c) & 1u) != 0u && (info.x & SRS_FLAG_FIXED) == 0u &&
            sampleShape(c, ownAtStart(c, real3(imageLoad(i_start, texel).xyz))).w < 0.0)
            holder = uint(c + 1);
    }
    if (holder != before) {
        info.x = (info.x & ~(SRS_HELD_MASK << SRS_HELD_SHIFT)) | (holder << SRS_HELD_SHIFT);
        imageStore(i_nodeInfo, texel, info);
    }
    if (holder == 0u)
        return;
    countHeld(u_now, holder, b_node[numberOf(texel)].mass);
    uint at = atomicAdd(b_heldCount, 1u);
    b_heldNode[at] = numberOf(texel);
    atomicMax(b_heldGroups, at / 64u + 1u);
}
