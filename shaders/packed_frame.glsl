// A node's rotation in 64 bits, and how it is found (render/node_frames.cpp has the twins).
//
// Packing: modified Rodrigues parameters m = xyz / (1 + w) of the quaternion with w >= 0, 21 bits a coordinate. They stay
// within 1, are as fine everywhere (4e-6 rad), need no trigonometry, and no turn is exact.
#include "mapping_constants.h"

uvec2 packFrame(vec4 q) {
    vec3 m = (q.w < 0.0 ? -q.xyz : q.xyz) / (1.0 + abs(q.w));
    uvec3 s = uvec3(ivec3(floor(m * SRS_FRAME_HALF_STEPS + 0.5)) + 0x100000);
    return uvec2(s.x | (s.z & 0x7ffu) << 21, s.y | s.z >> 11 << 21);
}

vec4 unpackFrame(uvec2 bits) {
    ivec3 s = ivec3(bits.x & 0x1fffffu, bits.y & 0x1fffffu, bits.x >> 21 | (bits.y >> 21) << 11) - 0x100000;
    vec3 m = vec3(s) * (1.0 / SRS_FRAME_HALF_STEPS);
    float s2 = dot(m, m), scale = 1.0 / (1.0 + s2);
    return vec4(2.0 * scale * m, (1.0 - s2) * scale);
}

/// The rotation R that is nearest to F: it maximizes tr(R^T F), also where F is flat (the limit of thinner and thinner ones)
/// or inverted. Horn 1987, J. Opt. Soc. Am. A 4, 629: its quaternion is the eigenvector of the largest eigenvalue of a
/// symmetric 4x4 matrix without trace. That is found by squaring: shifted by F's mean stretch, the matrix of a pure
/// rotation has the eigenvalues 4, 0, 0, 0 times that stretch.
vec4 rotationOf(mat3 f) {
    float shift = sqrt((dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2])) * (1.0 / 3.0));
    if (shift < 1e-6)
        return vec4(0.0, 0.0, 0.0, 1.0); // collapsed to a point
    vec3 anti = vec3(f[1][2] - f[2][1], f[2][0] - f[0][2], f[0][1] - f[1][0]);
    float xy = f[0][1] + f[1][0], xz = f[0][2] + f[2][0], yz = f[1][2] + f[2][1];
    float xx = f[0][0], yy = f[1][1], zz = f[2][2];
    mat4 m = mat4(xx - yy - zz + shift, xy, xz, anti.x, //
                  xy, yy - xx - zz + shift, yz, anti.y, //
                  xz, yz, zz - xx - yy + shift, anti.z, //
                  anti, xx + yy + zz + shift);
    for (int i = 0; i < SRS_FRAME_SQUARINGS; ++i) {
        m = m * m;
        m *= 1.0 / (m[0][0] + m[1][1] + m[2][2] + m[3][3]);
        // Trace 1: the sum of squares is 1 where the other eigenvalues are gone (1e-6 rad), mostly after three rounds.
        if (dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]) + dot(m[3], m[3]) > 0.999999)
            break;
    }
    // All columns are along the eigenvector by now: the longest is the most exact.
    vec4 first = m[0][0] > m[1][1] ? m[0] : m[1], second = m[2][2] > m[3][3] ? m[2] : m[3];
    return normalize(max(m[0][0], m[1][1]) > max(m[2][2], m[3][3]) ? first : second);
}
