// What a stroke cuts: twin of sim/blade.cpp, operation by operation, in double. `precise` everywhere: a fused
// multiply-add would round otherwise than the CPU. The idea and the proof's parts stand in sim/blade.h.
#include "shared_constants.h"

uniform int u_kind;        // SRS_STROKE_...
uniform vec4 u_corners[4]; // a0, b0, a1, b1, lattice units; cauterize: [0] the ball's centre
uniform float u_size;      // radius, or (1 + strain)^2

double dot3(dvec3 a, dvec3 b) {
    precise double sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}
dvec3 cross3(dvec3 a, dvec3 b) {
    precise dvec3 c = dvec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return c;
}
double largest3(dvec3 a) { return max(max(abs(a.x), abs(a.y)), abs(a.z)); }

// A strip of the patch, seen from the segment's lower end: the segment goes from 0 to g_d.
dvec3 g_d, g_x[4];
double g_reach;

bool separatedBy(dvec3 n) {
    precise double end = dot3(n, g_d);
    precise double low = min(double(0.0), end), high = max(double(0.0), end);
    precise double lowest = dot3(n, g_x[0]), highest = lowest;
    for (int i = 1; i < 4; ++i) {
        precise double at = dot3(n, g_x[i]);
        lowest = min(lowest, at);
        highest = max(highest, at);
    }
    precise double margin = double(SRS_BLADE_ROUNDING) * g_reach * (abs(n.x) + abs(n.y) + abs(n.z));
    precise double above = lowest - high, below = low - highest;
    return above > margin || below > margin;
}

bool separatedByBox() {
    return separatedBy(dvec3(1.0, 0.0, 0.0)) || separatedBy(dvec3(0.0, 1.0, 0.0)) ||
           separatedBy(dvec3(0.0, 0.0, 1.0));
}

/// Normals in the order of Strip::separated, made one at a time: the loop keeps the program small.
bool separated() {
    precise dvec3 edges[6] = {g_x[1] - g_x[0], g_x[2] - g_x[1], g_x[3] - g_x[2],
                              g_x[0] - g_x[3], g_x[2] - g_x[0], g_x[3] - g_x[1]};
    dvec3 n = cross3(edges[4], edges[5]);
    dvec3 w = cross3(g_d, g_x[0]);
    for (int i = 0; i < 32; ++i) {
        dvec3 normal = g_d;
        if (i >= 6 && i < 30) {
            dvec3 edge = edges[(i - 6) >> 2];
            dvec3 c = cross3(g_d, edge);
            int kind = (i - 6) & 3;
            normal = kind == 0 ? c : kind == 1 ? cross3(n, edge) : cross3(c, kind == 2 ? edge : g_d);
        } else if (i >= 30) {
            normal = cross3(i == 30 ? n : w, g_d);
        } else if (i > 0) {
            normal = i == 1   ? n
                     : i == 2 ? cross3(edges[0], edges[4])
                     : i == 3 ? cross3(edges[4], edges[3])
                     : i == 4 ? cross3(edges[0], edges[5])
                              : cross3(edges[1], edges[5]);
        }
        if (separatedBy(normal))
            return true;
    }
    return false;
}

bool bladeCuts(dvec3 p, dvec3 q) {
    precise dvec3 a0 = dvec3(u_corners[0].xyz) - p, b0 = dvec3(u_corners[1].xyz) - p;
    precise dvec3 a1 = dvec3(u_corners[2].xyz) - p, b1 = dvec3(u_corners[3].xyz) - p;
    precise dvec3 a = a1 - a0, b = b1 - b0, ends = q - p, farA = a0 + a, farB = b0 + b, turn = b - a;
    g_d = ends;
    g_reach = max(max(max(largest3(g_d), largest3(a0)), max(largest3(b0), largest3(farA))), largest3(farB));
    double twist = largest3(turn);
    uint index = 0u;
    int depth = 0;
    double width = 1.0;
    for (int test = 0; test < SRS_BLADE_MOST_TESTS; ++test) {
        precise double v0 = double(index) * width, v1 = double(index + 1u) * width;
        precise dvec3 x0 = a0 + v0 * a, x1 = b0 + v0 * b, x2 = b0 + v1 * b, x3 = a0 + v1 * a;
        g_x[0] = x0;
        g_x[1] = x1;
        g_x[2] = x2;
        g_x[3] = x3;
        if (separatedByBox() || separated()) {
            ++index;
            for (; depth > 0 && (index & 1u) == 0u; --depth) {
                index >>= 1;
                width *= 2.0;
            }
            if (depth == 0)
                return false;
        } else if (twist * width <= double(SRS_BLADE_FLAT)) {
            return true;
        } else {
            index <<= 1;
            ++depth;
            width *= 0.5;
        }
    }
    return true;
}

bool ballCuts(dvec3 p, dvec3 q) {
    precise dvec3 d = q - p, c = dvec3(u_corners[0].xyz) - p, e = dvec3(u_corners[0].xyz) - q;
    precise double along = dot3(c, d), length2 = dot3(d, d), radius2 = double(u_size) * double(u_size);
    if (along <= 0.0)
        return dot3(c, c) <= radius2;
    if (along >= length2)
        return dot3(e, e) <= radius2;
    precise double off = dot3(c, c) * length2 - along * along, limit = radius2 * length2;
    return off <= limit;
}

/// \param rest2 square of the spring's rest length: 1 or 2
bool strokeCuts(vec3 lower, vec3 higher, float rest2) {
    dvec3 p = dvec3(lower), q = dvec3(higher);
    if (u_kind == SRS_STROKE_BLADE)
        return bladeCuts(p, q);
    if (u_kind == SRS_STROKE_CAUTERIZE)
        return ballCuts(p, q);
    precise dvec3 d = q - p;
    precise double limit = double(u_size) * double(rest2);
    return dot3(d, d) > limit;
}
