// Closed-form maps that go forward, for the vertex stage (CS07 section 6.3; render/coarse_warp.h). Twin of forward() in
// render/deformation_map.cpp; texture space is m.
#include "raycast_constants.h"

struct CoarseMap {
    mat4 localFromObject, objectFromLocal;
    vec4 half_;   // of its box; w: SRS_COARSE_*
    vec4 numbers; // amount, radius, extent, 1 for a narrow pull
};
layout(std140) uniform b_coarse {
    CoarseMap b_map[SRS_COARSE_MAPS];
};
uniform int u_coarseMaps; // so many of them; the first acts next to rest

float coarseRise(CoarseMap map, float y) {
    return smoothstep(-map.half_.y, map.half_.y, y);
}

/// 1 in the middle, 0 from `end` on, within its last fifth.
float coarseWindow(float r, float end) {
    return 1.0 - smoothstep(0.8 * end, end, r);
}

vec3 coarseTwist(CoarseMap map, vec3 q) {
    float angle = map.numbers.x * coarseRise(map, q.y) * coarseWindow(length(q.xz), min(map.half_.x, map.half_.z));
    float c = cos(angle), s = sin(angle);
    return vec3(q.x * c + q.z * s, q.y, q.z * c - q.x * s);
}

vec3 coarseBend(CoarseMap map, vec3 q) {
    float amount = abs(map.numbers.x), extent = map.numbers.z, low = -0.5 * extent;
    if (q.y <= low || amount < 1e-6)
        return q;
    float side = sign(map.numbers.x), radius = extent / amount, x = side * q.x;
    float angle = min((q.y - low) / radius, amount), over = max(q.y - low - extent, 0.0);
    float c = cos(angle), s = sin(angle);
    return vec3(side * (radius - (radius - x) * c + over * s), low + (radius - x) * s + over * c, q.z);
}

/// How far a pull or a wave lifts the column of a point at the top.
float coarseLift(CoarseMap map, vec3 q) {
    const float kTurn = 6.283185307;
    float amount = map.numbers.x, radius = map.numbers.y;
    if (int(map.half_.w) == SRS_COARSE_WAVE)
        return amount * sin(kTurn * q.x / map.numbers.z) * coarseWindow(abs(q.x), map.half_.x) *
               coarseWindow(abs(q.z), map.half_.z);
    float r = length(q.xz), left = max(1.0 - r * r / (radius * radius), 0.0);
    return map.numbers.w > 0.5 ? amount * left * left * left
                               : amount * exp(-0.5 * r * r / (radius * radius)) *
                                     coarseWindow(r, min(map.half_.x, map.half_.z));
}

/// y' - up rise(y') = y, by Newton's steps within a bracket.
vec3 coarseLifted(CoarseMap map, vec3 q) {
    float up = coarseLift(map, q), low = min(q.y, q.y + up), high = max(q.y, q.y + up), y = q.y;
    for (int i = 0; i < SRS_COARSE_STEPS && high > low; ++i) {
        float miss = y - up * coarseRise(map, y) - q.y;
        low = miss < 0.0 ? y : low;
        high = miss < 0.0 ? high : y;
        float t = clamp((y + map.half_.y) / (2.0 * map.half_.y), 0.0, 1.0);
        float next = y - miss / (1.0 - up * 3.0 * t * (1.0 - t) / map.half_.y);
        y = next >= low && next <= high ? next : 0.5 * (low + high);
    }
    return vec3(q.x, y, q.z);
}

/// p', object space.
vec3 coarseForward(vec3 rest) {
    vec3 at = rest;
    for (int i = 0; i < u_coarseMaps; ++i) {
        CoarseMap map = b_map[i];
        int kind = int(map.half_.w);
        vec3 q = (map.localFromObject * vec4(at, 1.0)).xyz;
        if (kind == SRS_COARSE_TWIST)
            q = coarseTwist(map, q);
        else if (kind == SRS_COARSE_BEND)
            q = coarseBend(map, q);
        else
            q = coarseLifted(map, q);
        at = (map.objectFromLocal * vec4(q, 1.0)).xyz;
    }
    return at;
}

/// d p' / d p, by central differences.
mat3 coarseJacobian(vec3 rest, float by) {
    mat3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        vec3 step_ = vec3(0.0);
        step_[axis] = by;
        slope[axis] = (coarseForward(rest + step_) - coarseForward(rest - step_)) / (2.0 * by);
    }
    return slope;
}
