// What the passes of sim/lod_pass.h share. A node's word holds its texel (y << 16 | x; neither reaches 2^15) and whether it
// is fixed.
#include "shared_constants.h"

#define SRS_LOD_FIXED 0x8000u
ivec2 lodTexel(uint word) { return ivec2(word & 0x7fffu, word >> 16); }

layout(std430) readonly restrict buffer b_sources { uvec4 b_source[]; }; // rest position, word; one a source node
layout(std430) readonly restrict buffer b_entries { uvec2 b_entry[]; };  // source node, weight

/// Mean deformation gradient of the coarse cell whose corners are the eight entries from `first` on.
mat3 lodFrame(uint first, sampler2D positions) {
    mat3 frame = mat3(0.0);
    for (uint c = 0u; c < 8u; ++c) {
        vec3 x = texelFetch(positions, lodTexel(b_source[b_entry[first + c].x].w), 0).xyz * 0.25;
        frame[0] += (c & 1u) != 0u ? x : -x;
        frame[1] += (c & 2u) != 0u ? x : -x;
        frame[2] += (c & 4u) != 0u ? x : -x;
    }
    return frame;
}
