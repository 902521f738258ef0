// A node's texel in the position texture, for drawing.
#include "packed_normal.glsl"

uniform sampler2D t_positions; // xyz lattice units, alpha the packed normal

vec4 fetchNode(uint texel) {
    return texelFetch(t_positions, ivec2(texel & 0xffffu, texel >> 16), 0);
}

vec3 nodeNormal(vec4 node) {
    return unpackNormal(floatBitsToUint(node.w));
}
