// Distance of a place to what a stroke sweeps, where the organ lies now (lattice units): the bilinear patch of sim/blade.h, or a
// ball. The closest point of a bilinear patch is found by turns along its two families of lines, each exactly: a flat
// parallelogram with square corners needs two.
#include "shared_constants.h"

uniform int u_kind;        // SRS_STROKE_BLADE or SRS_STROKE_CAUTERIZE
uniform vec4 u_corners[4]; // a0, b0, a1, b1; cauterize: [0] the ball's centre
uniform float u_size;      // radius of the ball
uniform float u_facing;    // 1, or -1 where the stroke turned round since its first part

const int kTurns = 12;

float alongLine(vec3 from, vec3 to, vec3 point) {
    vec3 d = to - from;
    return clamp(dot(point - from, d) / max(dot(d, d), 1e-12), 0.0, 1.0);
}

/// x: distance, 0 or more; y: the same with the sign of the side that the place lies on (0: it has none).
vec2 strokeDistance(vec3 q) {
    if (u_kind == SRS_STROKE_CAUTERIZE)
        return vec2(max(distance(q, u_corners[0].xyz) - u_size, 0.0), 0.0);
    vec3 a0 = u_corners[0].xyz, b0 = u_corners[1].xyz, a1 = u_corners[2].xyz, b1 = u_corners[3].xyz;
    float u = 0.5, v = 0.5;
    for (int i = 0; i < kTurns; ++i) {
        v = alongLine(mix(a0, b0, u), mix(a1, b1, u), q);
        u = alongLine(mix(a0, a1, v), mix(b0, b1, v), q);
    }
    vec3 away = q - mix(mix(a0, b0, u), mix(a1, b1, u), v);
    vec3 normal = u_facing * cross(mix(b0 - a0, b1 - a1, v), mix(a1 - a0, b1 - b0, u));
    return vec2(length(away), dot(away, normal) < 0.0 ? -length(away) : length(away));
}
