// Adds the rigid motion that keeps momentum (lod_correct.comp), and makes the normals (MS05 eq. 3) that drawing needs before
// the next step.
#version 450 core
#include "neighbour_texels.glsl"
#include "packed_normal.glsl"
layout(local_size_x = 64) in;

layout(std430) readonly restrict buffer b_masses { uvec2 b_mass[]; };
layout(std430) readonly restrict buffer b_motion { vec4 b_rigid[]; };
layout(rgba32ui) uniform readonly restrict uimage2D i_nodeInfo;
uniform int u_nodes;
uniform sampler2D t_positions, t_increments;
layout(rgba32f) uniform writeonly restrict image2D i_newPositions;
layout(rgba32f) uniform writeonly restrict image2D i_newIncrements;

void main() {
    int node = int(gl_GlobalInvocationID.x);
    if (node >= u_nodes)
        return;
    ivec2 texel = ivec2(b_mass[node].x & 0xffffu, b_mass[node].x >> 16), texels[SRS_NEIGHBOURS];
    vec3 x = texelFetch(t_positions, texel, 0).xyz, u = texelFetch(t_increments, texel, 0).xyz;
    vec3 from = texelFetch(t_positions, ivec2(b_mass[0].x & 0xffffu, b_mass[0].x >> 16), 0).xyz;
    if (uintBitsToFloat(b_mass[node].y) > 0.0)
        u += b_rigid[0].xyz + cross(b_rigid[1].xyz, x - from - b_rigid[2].xyz);
    beginAddresses(texel);
    listNeighbours(texels);
    uint bits = imageLoad(i_nodeInfo, texel).x & SRS_CONNECTION_MASK;
    vec3 normal = vec3(0.0);
    for (int d = 0; d < SRS_NEIGHBOURS; ++d)
        if ((bits >> d & 1u) != 0u) {
            vec3 apart = x - texelFetch(t_positions, texels[d], 0).xyz;
            float rest2 = d < 6 ? 1.0 : 2.0; // as the step has it: exactly 1 at rest
            normal += inversesqrt(max(dot(apart, apart) * (1.0 / rest2), 1e-12)) * (d < 6 ? 1.0 : 0.70710678) * apart;
        }
    imageStore(i_newPositions, texel, vec4(x, uintBitsToFloat(packNormal(normal))));
    imageStore(i_newIncrements, texel, vec4(u, 0.0));
}
