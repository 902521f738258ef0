// The trilinear map of a deformed cell and its inverse (render/lattice_warp.h).
#include "lattice_warp_box.glsl"
#include "raycast_constants.h"

#ifdef WARP_CUT
#include "shared_constants.h"
#endif

struct WarpCell {
    vec4 rest; // of its lowest corner
    uint texels[8];
};
layout(std430) restrict readonly buffer b_cells { WarpCell b_cell[]; };
#ifdef WARP_CUT
uniform sampler2D t_above, t_below; // nodes as each side of the cuts carries them (render/side_nodes.h)
const int kSides = 2;
vec4 nodeOf(uint texel, int side) {
    ivec2 at = ivec2(texel & 0xffffu, texel >> 16);
    return side == 0 ? texelFetch(t_above, at, 0) : texelFetch(t_below, at, 0);
}
#else
uniform sampler2D t_positions;
const int kSides = 1;
vec4 nodeOf(uint texel, int side) {
    return texelFetch(t_positions, ivec2(texel & 0xffffu, texel >> 16), 0);
}
#endif

// Whose a voxel is: how far outside of the cell (11 bits), then whether a cut is beside the cell, then the cell:
// the least word has it.
const uint kNobody = 0xffffffffu;
uint ownerOf(float outside, bool beside, uint cell) {
    return uint(min(outside * 950.0, 2046.0)) << 21 | uint(beside) << 20 | cell;
}
uint outsideOf(uint owner) {
    return owner >> 21;
}
/// Is it claimed by a cell beside a cut that does not hold it, so that tissue goes on there?
bool goesOn(uint owner) {
    return owner != kNobody && outsideOf(owner) != 0u && (owner >> 20 & 1u) != 0u;
}
uint cellOf(uint owner) {
    return owner & 0xfffffu;
}

/// x(s) = sum of the coefficients times 1, x, y, z, xy, xz, yz, xyz.
struct Trilinear {
    vec3 c[8];
};

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
        if (dot(miss, miss) < 1e-13)
            return true;
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
