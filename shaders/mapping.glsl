// MS05 3.3, eq. 9: a vertex from three node texels. Twin of mapSurface in render/surface_binding.cpp.
//
// One formula for both bases (render/triangle_basis.h): a normal N and the triangle's first edge give B = N x T and
// T = B x N. N is the triangle's (eq. 6) or the weighted mean of the nodes' (eq. 8); both normalized, which eq. 6 and 8 leave out.
// MAPPING_BASIS, a program: 0 all constant, 1 all corrected, 2 chosen per vertex.
#include "packed_normal.glsl"

uniform sampler2D t_positions; // xyz lattice units, alpha the packed normal

struct Mapped {
    vec3 position;
    vec3 t, n, b;
};

vec4 fetchNode(uint texel) {
    return texelFetch(t_positions, ivec2(texel & 0xffffu, texel >> 16), 0);
}

vec3 nodeNormal(vec4 node) {
    return unpackNormal(floatBitsToUint(node.w));
}

Mapped mapVertex(uvec3 texels, vec2 weights, vec3 offset, bool corrected) {
    vec4 p1 = fetchNode(texels.x), p2 = fetchNode(texels.y), p3 = fetchNode(texels.z);
    vec3 edge = p2.xyz - p1.xyz;
    float w3 = 1.0 - weights.x - weights.y;
#if MAPPING_BASIS != 1
    vec3 normal = cross(edge, p3.xyz - p1.xyz);
#endif
#if MAPPING_BASIS != 0
    vec3 mean = weights.x * nodeNormal(p1) + weights.y * nodeNormal(p2) + w3 * nodeNormal(p3);
#if MAPPING_BASIS == 1
    vec3 normal = mean;
#else
    normal = corrected ? mean : normal;
#endif
#endif
    Mapped mapped;
    mapped.n = normalize(normal);
    mapped.b = normalize(cross(mapped.n, edge));
    mapped.t = cross(mapped.b, mapped.n);
    // p3 plus differences: smaller numbers than three weighted positions, so less is rounded off
    mapped.position = p3.xyz + weights.x * (p1.xyz - p3.xyz) + weights.y * (p2.xyz - p3.xyz) +
                      offset.x * mapped.t + offset.y * mapped.n + offset.z * mapped.b;
    return mapped;
}
