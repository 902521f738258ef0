// Held nodes go with their tools, turns included, by no more than the grip can give; those that slip out are let go, in
// place. Twin of ContactStage::moveHeld.
#version 450 core
layout(local_size_x = 64) in;
#include "shape_distance.glsl"
#include "contact_loads.glsl"
#include "contact_nodes.glsl"
#include "contact_grasp.glsl"

layout(rgba32ui) uniform restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_start;
layout(rgba32f) uniform restrict image2D i_positions;
layout(rgba32f) uniform restrict image2D i_increments;

void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item < 8u)
        b_heldMass[(u_now + 2) % 3 * 8 + int(item)] = 0u;
    if (item >= b_heldCount)
        return;
    uint number = b_heldNode[item];
    ivec2 texel = texelAt(number);
    uvec4 info = imageLoad(i_nodeInfo, texel);
    uint holder = (info.x >> SRS_HELD_SHIFT) & SRS_HELD_MASK;
    if (holder == 0u || holder > uint(SRS_TOOLS)) // it slipped out before
        return;
    int c = int(holder) - 1;
    float mass = b_node[number].mass;
    if (modeOf(c) == SRS_TOOL_GRASP) {
        vec3 x = imageLoad(i_start, texel).xyz;
        vec4 free = imageLoad(i_positions, texel);
        real grip = b_collider[c].to.w;
        vec3 by = vec3(carried(c, real3(x)) - real3(free.xyz));
        float far = length(by), most = float(grip / max(heldMass(holder), 1e-9));
        if (far > most)
            by *= most / far;
        vec3 end = free.xyz + by;
        imageStore(i_positions, texel, vec4(end, free.w));
        imageStore(i_increments, texel, imageLoad(i_increments, texel) + vec4(by, 0.0));
        addLoad(c, mass, x, by);
        if (!holdsEndlessly(c) && sampleShape(c, ownAtEnd(c, real3(end))).w > SRS_GRIP_SLACK) {
            info.x &= ~(SRS_HELD_MASK << SRS_HELD_SHIFT);
            imageStore(i_nodeInfo, texel, info);
            return;
        }
    }
    countHeld((u_now + 1) % 3, holder, mass);
}
