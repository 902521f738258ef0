// Labels the pieces that cuts left: each node takes the least label among itself and its neighbours, then the label of the
// node that this label names (so that labels jump along a piece instead of walking). Passes are repeated until none changes
// one; a piece then bears the index of its first texel. Twin of pieceLabels in sim/pieces.cpp.
#version 450 core
#include "neighbour_texels.glsl"

layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
layout(r32ui) uniform readonly restrict uimage2D i_labels;
layout(r32ui) uniform writeonly restrict uimage2D i_changed; // one texel
uniform int u_width; // of the state textures
uniform int u_first; // 1: each node its own label

layout(location = 0) out uint o_label;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    uint info = imageLoad(i_nodeInfo, texel).x;
    o_label = 0xffffffffu;
    if ((info & SRS_FLAG_ACTIVE) == 0u)
        return;
    if (u_first != 0) {
        o_label = uint(texel.y * u_width + texel.x);
        return;
    }
    beginAddresses(texel);
    ivec2 texels[SRS_NEIGHBOURS];
    listNeighbours(texels);
    uint before = imageLoad(i_labels, texel).x, label = before;
    for (int d = 0; d < SRS_NEIGHBOURS; ++d)
        if (((info >> d) & 1u) != 0u)
            label = min(label, imageLoad(i_labels, texels[d]).x);
    label = min(label, imageLoad(i_labels, ivec2(int(label) % u_width, int(label) / u_width)).x);
    if (label != before)
        imageStore(i_changed, ivec2(0), uvec4(1u));
    o_label = label;
}
