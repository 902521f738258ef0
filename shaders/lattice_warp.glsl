// The trilinear map of a deformed cell and its inverse (render/lattice_warp.h).
#include "lattice_warp_box.glsl"
#include "raycast_constants.h"

struct WarpCell {
    vec4 rest; // of its lowest corner
    uint texels[8];
};
layout(std430) restrict readonly buffer b_cells { WarpCell b_cell[]; };
uniform sampler2D t_positions;

/// x(s) = sum of the coefficients times 1, x, y, z, xy, xz, yz, xyz.
struct Trilinear {
    vec3 c[8];
};

void cornersOf(uint cell, out vec3 corner[8]) {
    for (int k = 0; k < 8; ++k) {
        uint texel = b_cell[cell].texels[k];
        corner[k] = texelFetch(t_positions, ivec2(texel & 0xffffu, texel >> 16), 0).xyz;
    }
}

Trilinear trilinearOf(vec3 p[8]) {
    Trilinear t;
    t.c[0] = p[0];
    t.c[1] = p[1] - p[0];
    t.c[2] = p[2] - p[0];
    t.c[3] = p[4] - p[0];
    t.c[4] = p[3] - p[1] - p[2] + p[0];
    t.c[5] = p[5] - p[1] - p[4] + p[0];
    t.c[6] = p[6] - p[2] - p[4] + p[0];
    t.c[7] = p[7] - p[3] - p[5] - p[6] + p[1] + p[2] + p[4] - p[0];
    return t;
}

vec3 valueAt(Trilinear t, vec3 s) {
    return t.c[0] + s.x * (t.c[1] + s.y * (t.c[4] + s.z * t.c[7]) + s.z * t.c[5]) + s.y * (t.c[2] + s.z * t.c[6]) +
           s.z * t.c[3];
}

mat3 slopeAt(Trilinear t, vec3 s) {
    return mat3(t.c[1] + s.y * t.c[4] + s.z * t.c[5] + s.y * s.z * t.c[7],
                t.c[2] + s.x * t.c[4] + s.z * t.c[6] + s.x * s.z * t.c[7],
                t.c[3] + s.x * t.c[5] + s.y * t.c[6] + s.x * s.y * t.c[7]);
}

/// Where in the cell (0 to 1 along each axis; beyond: outside) the map takes to `at`. False where it finds none.
bool invert(Trilinear t, vec3 at, out vec3 s) {
    s = vec3(0.5);
    vec3 miss = valueAt(t, s) - at;
    for (int i = 0; i < SRS_WARP_STEPS; ++i) {
        mat3 slope = slopeAt(t, s);
        if (abs(determinant(slope)) < 1e-9)
            return false;
        s = clamp(s - inverse(slope) * miss, vec3(-2.0), vec3(3.0));
        miss = valueAt(t, s) - at;
    }
    return dot(miss, miss) < 1e-6 * dot(t.c[1] + t.c[2] + t.c[3], t.c[1] + t.c[2] + t.c[3]) + 1e-8;
}

/// How far outside of the cell, in cells.
float outsideBy(vec3 s) {
    vec3 out_ = max(-s, s - 1.0);
    return max(max(out_.x, max(out_.y, out_.z)), 0.0);
}
