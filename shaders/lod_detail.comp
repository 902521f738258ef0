// What the coarse lattice does not hold of the fine shape, in the frames of its cells: detailOf in sim/lod.cpp. Sources are
// the coarse nodes, rows those from coarse to fine.
#version 450 core
#include "lod.glsl"
layout(local_size_x = 64) in;

layout(std430) readonly restrict buffer b_targets { uvec4 b_target[]; };
layout(std430) writeonly restrict buffer b_detail { vec4 b_fineDetail[]; };
uniform int u_nodes;
uniform float u_lengthScale;
uniform sampler2D t_coarse, t_fine; // positions

void main() {
    int node = int(gl_GlobalInvocationID.x);
    if (node >= u_nodes)
        return;
    uvec4 target = b_target[2 * node];
    uint first = b_target[2 * node + 1].x;
    vec3 moved = vec3(0.0);
    for (uint c = 0u; c < 8u; ++c) {
        uvec2 entry = b_entry[first + c];
        uvec4 source = b_source[entry.x];
        moved += uintBitsToFloat(entry.y) *
                 (texelFetch(t_coarse, lodTexel(source.w), 0).xyz - uintBitsToFloat(source.xyz));
    }
    vec3 left = texelFetch(t_fine, lodTexel(target.w), 0).xyz - uintBitsToFloat(target.xyz) - u_lengthScale * moved;
    mat3 frame = lodFrame(first, t_coarse);
    bool carries = determinant(frame) > SRS_LOD_LEAST_VOLUME && (target.w & SRS_LOD_FIXED) == 0u;
    b_fineDetail[node] = vec4(carries ? inverse(frame) * left : vec3(0.0), 0.0);
}
