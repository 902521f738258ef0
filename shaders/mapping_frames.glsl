// Node frames, which go beyond MS05: the vertex is its reference point (eq. 4) and its offset in the axes of the lattice at
// rest, turned by the rotations of the three nodes (node_frames.comp), blended with the weights of eq. 4. On an edge that two
// triangles share both see the same two nodes with the same weights: the mapping is continuous there, which the bases of
// eq. 6 and 8 are not.
#include "packed_frame.glsl"

layout(location = 0) in uvec3 a_texels; // y << 16 | x
layout(location = 1) in vec2 a_weights; // w1, w2
layout(location = 2) in vec3 a_offset;  // lattice axes and units

uniform usampler2D t_frames; // packed, at the texels of t_positions

vec4 fetchFrame(uint texel) {
    return unpackFrame(texelFetch(t_frames, ivec2(texel & 0xffffu, texel >> 16), 0).xy);
}

/// A quaternion and its negative are the same rotation: all are taken on the side of the heaviest. (Of the first, a node
/// without weight could decide, and another one on either side of an edge.)
vec4 blend(vec4 q1, vec4 q2, vec4 q3, vec3 w) {
    vec4 heaviest = w.x >= w.y && w.x >= w.z ? q1 : w.y >= w.z ? q2 : q3;
    return normalize((dot(q1, heaviest) < 0.0 ? -w.x : w.x) * q1 + (dot(q2, heaviest) < 0.0 ? -w.y : w.y) * q2 +
                     (dot(q3, heaviest) < 0.0 ? -w.z : w.z) * q3);
}

mat3 matrixOf(vec4 q) {
    vec3 d = 2.0 * q.xyz, s = d * q.xyz;                        // doubled; squares
    vec3 p = vec3(d.x * q.y, d.y * q.z, d.z * q.x), r = d * q.w; // xy, yz, zx; with w
    return mat3(1.0 - s.y - s.z, p.x + r.z, p.z - r.y, //
                p.x - r.z, 1.0 - s.x - s.z, p.y + r.x, //
                p.z + r.y, p.y - r.x, 1.0 - s.x - s.y);
}

Mapped mapOwn() {
    vec4 p1 = fetchNode(a_texels.x), p2 = fetchNode(a_texels.y), p3 = fetchNode(a_texels.z);
    vec3 w = vec3(a_weights, 1.0 - a_weights.x - a_weights.y);

    Mapped mapped;
    mapped.axes = matrixOf(blend(fetchFrame(a_texels.x), fetchFrame(a_texels.y), fetchFrame(a_texels.z), w));
    mapped.turn = mapped.axes;
    mapped.normal = mapped.axes * unpackNormal(a_normal);
    mapped.dynamicNormal = normalize(w.x * nodeNormal(p1) + w.y * nodeNormal(p2) + w.z * nodeNormal(p3));
    mapped.position = p3.xyz + w.x * (p1.xyz - p3.xyz) + w.y * (p2.xyz - p3.xyz) + mapped.axes * a_offset;
    return mapped;
}
