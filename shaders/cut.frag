// Clears the bits of the springs that a stroke cuts, by rewriting the node info texture: twin of cutConnections in
// sim/blade.cpp. Both ends of a spring decide from the same two positions in the same order, so they agree without being
// told. What was cleared is kept in a layer, for undo.
#version 450 core
#include "neighbour_texels.glsl"
#include "blade.glsl"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(rgba32f) uniform readonly restrict image2D i_positions;
layout(r32ui) uniform restrict uimage2D i_cleared; // bits that this stroke cleared so far

layout(location = 0) out uvec4 o_nodeInfo;

// Directions that lead to a node with a higher index (leadsToHigherIndex in sim/blade.cpp).
const uint kHigher = SRS_HIGHER_DIRECTIONS;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    uvec4 info = imageLoad(i_nodeInfo, texel);
    uint bits = info.x & SRS_CONNECTION_MASK;
    o_nodeInfo = info;
    if (bits == 0u)
        return;
    beginAddresses(texel);
    ivec2 texels[SRS_NEIGHBOURS];
    listNeighbours(texels);
    vec3 here = imageLoad(i_positions, texel).xyz;
    uint cleared = 0u;
    for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
        if (((bits >> d) & 1u) == 0u)
            continue;
        vec3 there = imageLoad(i_positions, texels[d]).xyz;
        bool up = ((kHigher >> d) & 1u) != 0u;
        if (strokeCuts(up ? here : there, up ? there : here, d < 6 ? 1.0 : 2.0))
            cleared |= 1u << d;
    }
    if (cleared == 0u)
        return;
    o_nodeInfo.x &= ~cleared;
    imageStore(i_cleared, texel, imageLoad(i_cleared, texel) | uvec4(cleared, 0u, 0u, 0u));
}
