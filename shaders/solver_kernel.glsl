// One step of one node: MS05 section 3.1, eq. 2 (or eq. 1 with SRS_EQUATION 1) and eq. 3, for the cell lattice of
// sim/lattice.h. Twin of sim/reference_solver.cpp; what a step does stands in sim/solver.h. Unrolled: loops over
// neighbours are twice slower on llvmpipe.
//
// Departures from MS05: k is the full constant, not a half; each spring's weight comes from the fills of the cells that
// hold it; the increment is stored instead of the last position.
#include "lattice_address.glsl"
#include "packed_normal.glsl"

uniform float u_acceleration; // dt^2 k / (rho h^3)
uniform float u_damping;      // damping time / dt
uniform float u_drag;         // 1 - air drag dt
uniform vec3 u_gravity;       // dt^2 g / h

// Sums over the springs; weights are integers in units of k/1020, so that both ends sum the same.
vec3 g_position, g_increment, g_force, g_normal;

void addSpring(float weight, float rest, float rest2, ivec2 texel) {
#ifdef SRS_TEXEL_FETCH
    if (weight == 0.0) // outside of the texture a fetch is undefined
        texel = ivec2(0);
#endif
    vec3 d = g_position - loadPosition(texel);
#if SRS_EQUATION == 2
    // Scaled so that the square root is of 1 at rest: the rest state then has no force at all in float32.
    float stretch = inversesqrt(max(dot(d, d) * (1.0 / rest2), 1e-12));
    vec3 unit = d * (stretch * (1.0 / rest));
    g_force += (weight * (stretch - 1.0)) * d;
#else
    float len = max(length(d), 1e-6);
    vec3 unit = d / len;
    g_force += weight * (rest - len) * unit;
#endif
#ifdef SRS_DAMPING
    g_force -= (weight * u_damping * dot(unit, g_increment - loadIncrement(texel))) * unit;
#endif
#ifdef SRS_NORMALS
    g_normal += weight > 0.0 ? unit : vec3(0.0); // eq. 3
#endif
}

#ifdef SRS_VOLUME
#include "solver_volume.glsl"
#endif

float connected(uint bits, int d) { return float((bits >> d) & 1u); }

/// Force in units of k h / 1020, and the sum of unit vectors; returns the sum of the node's fills (0 .. 2040).
float sumSprings(uvec4 info, vec3 position, vec3 increment) {
    const float diagonal = 1.41421356;
    g_position = position;
    g_increment = increment;
    g_force = vec3(0.0);
    g_normal = vec3(0.0);
    // Fills of the cells with z below (a) and above (b); components (-x-y, +x-y, -x+y, +x+y).
    vec4 a = vec4((info.yyyy >> uvec4(0, 8, 16, 24)) & 255u);
    vec4 b = vec4((info.zzzz >> uvec4(0, 8, 16, 24)) & 255u);
    vec4 xy = a + b;               // sums over z: the diagonals in the xy plane
    vec2 xBelow = a.xy + a.zw, xAbove = b.xy + b.zw; // -x, +x; sums over y
    vec2 yBelow = a.xz + a.yw, yAbove = b.xz + b.yw; // -y, +y; sums over x
    vec2 x = xBelow + xAbove, y = yBelow + yAbove;
    float zBelow = yBelow.x + yBelow.y, zAbove = yAbove.x + yAbove.y;
    uint bits = info.x;

    addSpring(connected(bits, 0) * x.y, 1.0, 1.0, neighbourTexel(1, 0, 0, ROW_SAME));
    addSpring(connected(bits, 1) * x.x, 1.0, 1.0, neighbourTexel(-1, 0, 0, ROW_SAME));
    addSpring(connected(bits, 2) * y.y, 1.0, 1.0, neighbourTexel(0, 1, 0, ROW_Y));
    addSpring(connected(bits, 3) * y.x, 1.0, 1.0, neighbourTexel(0, -1, 0, ROW_y));
    addSpring(connected(bits, 4) * zAbove, 1.0, 1.0, neighbourTexel(0, 0, 1, ROW_Z));
    addSpring(connected(bits, 5) * zBelow, 1.0, 1.0, neighbourTexel(0, 0, -1, ROW_z));
    addSpring(connected(bits, 6) * 2.0 * xy.w, diagonal, 2.0, neighbourTexel(1, 1, 0, ROW_Y));
    addSpring(connected(bits, 7) * 2.0 * xy.x, diagonal, 2.0, neighbourTexel(-1, -1, 0, ROW_y));
    addSpring(connected(bits, 8) * 2.0 * xy.y, diagonal, 2.0, neighbourTexel(1, -1, 0, ROW_y));
    addSpring(connected(bits, 9) * 2.0 * xy.z, diagonal, 2.0, neighbourTexel(-1, 1, 0, ROW_Y));
    addSpring(connected(bits, 10) * 2.0 * xAbove.y, diagonal, 2.0, neighbourTexel(1, 0, 1, ROW_Z));
    addSpring(connected(bits, 11) * 2.0 * xBelow.x, diagonal, 2.0, neighbourTexel(-1, 0, -1, ROW_z));
    addSpring(connected(bits, 12) * 2.0 * xBelow.y, diagonal, 2.0, neighbourTexel(1, 0, -1, ROW_z));
    addSpring(connected(bits, 13) * 2.0 * xAbove.x, diagonal, 2.0, neighbourTexel(-1, 0, 1, ROW_Z));
    addSpring(connected(bits, 14) * 2.0 * yAbove.y, diagonal, 2.0, neighbourTexel(0, 1, 1, ROW_YZ));
    addSpring(connected(bits, 15) * 2.0 * yBelow.x, diagonal, 2.0, neighbourTexel(0, -1, -1, ROW_yz));
    addSpring(connected(bits, 16) * 2.0 * yBelow.y, diagonal, 2.0, neighbourTexel(0, 1, -1, ROW_Yz));
    addSpring(connected(bits, 17) * 2.0 * yAbove.x, diagonal, 2.0, neighbourTexel(0, -1, 1, ROW_yZ));
#ifdef SRS_VOLUME
    addVolume(info);
#endif
    return zBelow + zAbove;
}
