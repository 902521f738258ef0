// Nearest triangles of render/distance_volume.h beyond the narrow band. That of the nearest voxel of the band is too far by at
// most half of a voxel's diagonal; within u_band the tree of boxes is asked for all that is nearer still. Of equals the lowest.
#version 450 core
#include "distance_triangle.glsl"
layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;

struct TreeNode {
    vec3 lowest;
    uint skip;
    vec3 highest;
    uint leaf; // 8 begin + count; 0: its first child follows
};
layout(std430) restrict readonly buffer b_tree { TreeNode b_node[]; };
layout(r32ui) uniform restrict readonly uimage3D i_owner; // nearest triangle of a voxel of the band
layout(r32ui) uniform restrict readonly uimage3D i_seeds; // nearest voxel of the band
layout(r32ui) uniform restrict writeonly uimage3D i_nearest;
uniform ivec3 u_size;
uniform float u_band; // voxels
uniform int u_nodes;

const uint kNone = 0xffffffffu;

vec3 p;
uint best = kNone;
float least = 1e9;

void offer(uint triangle) {
    int feature;
    float far = distance(p, closestOf(triangle, p, feature));
    if (far < least || (far == least && triangle < best)) {
        least = far;
        best = triangle;
    }
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, u_size)))
        return;
    p = vec3(at);
    uint seedAt = imageLoad(i_seeds, at).x;
    if (seedAt != kNone) {
        ivec3 seed = ivec3(seedAt & 1023u, seedAt >> 10 & 1023u, seedAt >> 20 & 1023u);
        offer(imageLoad(i_owner, seed).x);
        bool search = seed != at && least < u_band + 1.0;
        for (int i = 0; search && i < u_nodes;) {
            TreeNode node = b_node[i];
            vec3 apart = p - clamp(p, node.lowest, node.highest);
            if (dot(apart, apart) > least * least) {
                i = int(node.skip);
                continue;
            }
            for (uint k = node.leaf >> 3; k < (node.leaf >> 3) + (node.leaf & 7u); ++k)
                offer(k);
            ++i;
        }
    }
    imageStore(i_nearest, at, uvec4(best));
}
