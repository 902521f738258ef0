#version 450 core
// A rotation a node of the lattice's boundary, from the deformation of its neighbours (render/node_frames.h):
// F = sum_j (x_j - x_i) g_j^T, the least-squares deformation gradient, with vectors g_j that the CPU keeps for what
// connections are left; its rotation is stored packed, at the node's texel.
#include "packed_frame.glsl"

layout(local_size_x = SRS_FRAME_GROUP) in;
layout(std430) readonly restrict buffer b_rows { uvec4 b_row[]; }; // texel, texel of x_i, first term, terms
uniform usampler2D t_terms; // g_j as bits of floats, texel of x_j (llvmpipe fetches texels faster than words of buffers)
layout(rg32ui) uniform writeonly restrict uimage2D i_frames;
uniform sampler2D t_positions;
uniform int u_rows;

ivec2 texelOf(uint word) { return ivec2(word & 0xffffu, word >> 16); }

void main() {
    uint row = gl_GlobalInvocationID.x;
    if (row >= uint(u_rows))
        return;
    uvec4 node = b_row[row];
    vec3 centre = texelFetch(t_positions, texelOf(node.y), 0).xyz;
    mat3 f = mat3(0.0);
    for (uint i = node.z; i < node.z + node.w; ++i) {
        uvec4 term = texelFetch(t_terms, ivec2(i % SRS_TABLE_WIDTH, i / SRS_TABLE_WIDTH), 0);
        f += outerProduct(texelFetch(t_positions, texelOf(term.w), 0).xyz - centre, uintBitsToFloat(term.xyz));
    }
    imageStore(i_frames, texelOf(node.x), uvec4(packFrame(rotationOf(f)), 0u, 0u));
}
