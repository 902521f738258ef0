// Last pass of render/distance_volume.h: signed distances, voxels.
#version 450 core
#include "distance_triangle.glsl"
layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;

layout(std430) restrict readonly buffer b_faceNormals { vec4 b_faceNormal[]; };
layout(std430) restrict readonly buffer b_edgeNormals { vec4 b_edgeNormal[]; };   // three a triangle
layout(std430) restrict readonly buffer b_cornerNormals { vec4 b_cornerNormal[]; };
layout(r32ui) uniform restrict readonly uimage3D i_owner; // nearest triangle of a voxel of the band
layout(r32ui) uniform restrict readonly uimage3D i_seeds; // nearest voxel of the band
layout(r32ui) uniform restrict readonly uimage3D i_nearest; // triangle that is nearest to a voxel
layout(r16f) uniform restrict writeonly image3D i_distance;
uniform ivec3 u_size;

const uint kNone = 0xffffffffu;

float signedDistance(uint triangle, vec3 p) {
    int feature;
    vec3 away = p - closestOf(triangle, p, feature);
    vec3 normal = feature == 0  ? b_faceNormal[triangle].xyz
                  : feature < 4 ? b_edgeNormal[3u * triangle + uint(feature - 1)].xyz
                                : b_cornerNormal[b_triangle[triangle][feature - 4]].xyz;
    float far = length(away);
    return dot(away, normal) < 0.0 ? -far : far;
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, u_size)))
        return;
    uint seedAt = imageLoad(i_seeds, at).x;
    float value = 60000.0; // no surface at all
    if (seedAt != kNone) {
        ivec3 seed = ivec3(seedAt & 1023u, seedAt >> 10 & 1023u, seedAt >> 20 & 1023u);
        value = signedDistance(imageLoad(i_owner, seed).x, vec3(seed));
        if (seed != at) {
            int feature;
            float far = distance(vec3(at), closestOf(imageLoad(i_nearest, at).x, vec3(at), feature));
            value = value < 0.0 ? -far : far;
        }
    }
    imageStore(i_distance, at, vec4(value));
}
