// A unit normal in the 32 bits of a float32 alpha channel (MS05 3.2), twin of sim/packed_normal.cpp.
//
// Octahedral map, 15 bits a coordinate. SRS_NORMAL_HALF_STEPS divides by 2, 3 and 4, so that the normals of flat faces,
// edges and corners of the lattice are exact. The 30 bits go around bit 30 (always 0) and bit 23 (always 1): the
// exponent is never 0 and never 255, so no hardware flushes or rewrites the pattern.
#include "shared_constants.h"

uint packNormal(vec3 direction) {
    float sum = abs(direction.x) + abs(direction.y) + abs(direction.z);
    vec3 n = sum > 0.0 ? direction / sum : vec3(0.0, 1.0, 0.0);
    vec2 e = n.xy;
    if (n.z < 0.0)
        e = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    uvec2 q = uvec2(floor(e * SRS_NORMAL_HALF_STEPS + (SRS_NORMAL_HALF_STEPS + 0.5)));
    uint data = q.x | q.y << 15;
    return (data & 0x7fffffu) | 0x800000u | (data & 0x1f800000u) << 1 | (data & 0x20000000u) << 2;
}

vec3 unpackNormal(uint bits) {
    uint data = (bits & 0x7fffffu) | (bits >> 1 & 0x1f800000u) | (bits >> 2 & 0x20000000u);
    vec2 e = (vec2(data & 0x7fffu, data >> 15) - SRS_NORMAL_HALF_STEPS) * (1.0 / SRS_NORMAL_HALF_STEPS);
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float fold = max(-n.z, 0.0);
    n.xy -= vec2(n.x >= 0.0 ? fold : -fold, n.y >= 0.0 ? fold : -fold);
    return normalize(n);
}
