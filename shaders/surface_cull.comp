#version 450 core
// Which clusters of the detailed surface are drawn (render/surface_clusters.h): one invocation a cluster looks at the nodes that carry
// it. Mapped vertices lie within `reach` of triangles of these nodes, since both bases keep an offset's length.
#include "packed_normal.glsl"

layout(local_size_x = 64) in;

struct Cluster {
    uint first, count, node, nodes;
    float reach, facing;
};
struct Draw { // DrawElementsIndirectCommand
    uint count, instances, first;
    int vertex;
    uint instance;
};
layout(std430) readonly restrict buffer b_clusters { Cluster clusters[]; };
layout(std430) readonly restrict buffer b_nodes { uint texels[]; };
layout(std430) writeonly restrict buffer b_draws { Draw draws[]; };

uniform sampler2D t_positions; // xyz lattice units, alpha the packed normal
uniform mat4 u_clipFromLattice;
uniform vec4 u_eye; // lattice units, w = 1; or the direction to the eye, w = 0
uniform int u_clusters;

/// Is a box outside of one plane of the view?
bool outside(vec3 low, vec3 high) {
    vec4 beyond = vec4(1.0); // 1 while all corners are: left, right, below, above
    bool behind = true, farther = true;
    for (int c = 0; c < 8; ++c) {
        vec3 corner = mix(low, high, vec3(c & 1, c >> 1 & 1, c >> 2));
        vec4 clip = u_clipFromLattice * vec4(corner, 1.0);
        beyond *= vec4(clip.x < -clip.w, clip.x > clip.w, clip.y < -clip.w, clip.y > clip.w);
        behind = behind && clip.z < -clip.w;
        farther = farther && clip.z > clip.w;
    }
    return beyond != vec4(0.0) || behind || farther;
}

vec4 nodeOf(uint place) {
    uint texel = texels[place];
    return texelFetch(t_positions, ivec2(texel & 0xffffu, texel >> 16), 0);
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(u_clusters))
        return;
    Cluster cluster = clusters[i];
    vec3 low = vec3(1e30), high = vec3(-1e30);
    vec3 normal = vec3(0.0);
    for (uint k = 0u; k < cluster.nodes; ++k) {
        vec4 node = nodeOf(cluster.node + k);
        low = min(low, node.xyz);
        high = max(high, node.xyz);
        normal += unpackNormal(floatBitsToUint(node.w));
    }
    normal = normalize(normal);
    float towards = -1.0; // the most that it faces the eye, seen from any of the nodes
    for (uint k = 0u; k < cluster.nodes; ++k) {
        vec3 at = nodeOf(cluster.node + k).xyz;
        towards = max(towards, dot(normal, normalize(u_eye.xyz - at * u_eye.w)));
    }
    bool hidden = towards < cluster.facing || outside(low - cluster.reach, high + cluster.reach);
    draws[i] = Draw(hidden ? 0u : cluster.count, hidden ? 0u : 1u, cluster.first, 0, 0u);
}
