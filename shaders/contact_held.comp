// Held nodes go with their tools, turns included, by no more than the grip can give; those that slip out are let go, in
// place. Twin of ContactStage::moveHeld.
#version 450 core
layout(local_size_x = SRS_GROUP_X, local_size_y = SRS_GROUP_Y) in;
#include "shape_distance.glsl"
#include "contact_loads.glsl"
#include "contact_nodes.glsl"
#include "contact_grasp.glsl"

layout(rgba32ui) uniform restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_start;
layout(rgba32f) uniform restrict image2D i_positions;
layout(rgba32f) uniform restrict image2D i_increments;

const float kEndlessGrip = 1e29; // contact_pass.cpp

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel == ivec2(0))
        for (int i = 0; i < 8; ++i)
            b_heldMass[(u_now + 2) % 3 * 8 + i] = 0u;
    if (any(greaterThanEqual(texel, imageSize(i_nodeInfo))))
        return;
    uvec4 info = imageLoad(i_nodeInfo, texel);
    uint holder = (info.x >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    if (holder == 0u || holder > uint(SRS_TOOLS) || (info.x & SRS_FLAG_ACTIVE) == 0u)
        return;
    int c = int(holder) - 1;
    float mass = b_node[numberOf(texel)].mass;
    if (modeOf(c) == SRS_TOOL_GRASP) {
        vec3 x = imageLoad(i_start, texel).xyz;
        vec4 free = imageLoad(i_positions, texel);
        double grip = b_collider[c].to.w;
        vec3 by = vec3(carried(c, dvec3(x)) - dvec3(free.xyz));
        float far = length(by), most = float(grip / max(heldMass(holder), 1e-9));
        if (far > most)
            by *= most / far;
        vec3 end = free.xyz + by;
        imageStore(i_positions, texel, vec4(end, free.w));
        imageStore(i_increments, texel, imageLoad(i_increments, texel) + vec4(by, 0.0));
        addLoad(c, mass, x, by);
        if (grip < kEndlessGrip && sampleShape(c, ownAtEnd(c, dvec3(end))).w > SRS_GRIP_SLACK) {
            info.x &= ~(SRS_HELD_MASK << SRS_HELD_SHIFT);
            imageStore(i_nodeInfo, texel, info);
            return;
        }
    }
    countHeld((u_now + 1) % 3, holder, mass);
}
