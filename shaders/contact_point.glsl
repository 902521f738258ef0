// Contact of one material point with a collider during a step, in the collider's own frame: twin of
// sim/contact_point.cpp, which says what is done and why.
#include "shape_distance.glsl"

const float kEndless = 1e30;
const float kClose = 1e-6; // of a gap that is sought: float32 tells no more apart

float contactDepthFor(float depth, float thin) { return max(depth, -0.5 * thin); }

int sweepSamples(float path, float thin) {
    return clamp(int(min(ceil(path / (0.5 * thin)), float(SRS_SWEEP_SAMPLES))), 1, SRS_SWEEP_SAMPLES);
}

/// Least t >= 0 with phi(p + t n) >= target.
float distanceOut(int c, vec3 p, vec3 n, float target) {
    float t = 0.0, low = 0.0, high = kEndless;
    for (int i = 0; i < 40; ++i) {
        vec4 there = sampleShape(c, p + t * n);
        float gap = there.w - target, slope = dot(there.xyz, n);
        if ((i == 0 && gap >= 0.0) || abs(gap) < kClose)
            return t;
        if (gap < 0.0)
            low = t;
        else
            high = t;
        float next = slope > 0.1 ? t - gap / slope : t + abs(gap);
        if (!(next > low && next < high))
            next = high < kEndless ? 0.5 * (low + high) : t + abs(gap);
        if (!(next > low && next < high)) // the bracket is one rounding wide
            break;
        t = next;
    }
    return high < kEndless ? high : t;
}

vec3 onTheWay(vec3 y0, vec3 y1, float s) { return s == 1.0 ? y1 : y0 + s * (y1 - y0); }

/// What moves the point out at the step's end; zero where nothing touches.
vec3 pointContact(int c, vec3 y0, vec3 y1, float depth, int samples) {
    vec4 start = sampleShape(c, y0);
    float endGap = sampleShape(c, y1).w - depth, gap = start.w - depth, target = 0.0;
    bool any = false, through = false, inside = gap < 0.0;
    vec3 at = y0, n = start.xyz;
    if (inside) {
        target = min(0.0, gap + SRS_EJECTION);
        any = endGap < target;
    }
    // First touch on the way; inside: does it go deeper on the way and come out again?
    float limit = inside ? gap : 0.0, before = 0.0, touched = 1.0;
    int last = inside ? samples - 1 : samples;
    for (int k = 1; k <= last && !any; ++k) {
        touched = k == samples ? 1.0 : float(k) / float(samples);
        float here = k == samples ? endGap : sampleShape(c, onTheWay(y0, y1, touched)).w - depth;
        any = here < limit;
        if (!any)
            before = touched;
    }
    if (!any)
        return vec3(0.0);
    if (inside) {
        through = !(endGap < target);
    } else {
        through = touched < 1.0 && endGap >= 0.0;
        for (int i = 0; i < SRS_SWEEP_BISECTIONS; ++i) {
            float middle = 0.5 * (before + touched);
            if (sampleShape(c, onTheWay(y0, y1, middle)).w - depth < 0.0)
                touched = middle;
            else
                before = middle;
        }
        at = onTheWay(y0, y1, before);
        vec4 there = sampleShape(c, at);
        n = there.xyz;
        gap = there.w - depth;
    }
    // The way out, then friction's share of the motion, and the way out from there.
    float friction = b_collider[c].to.w;
    vec3 motion = y1 - y0, along = motion - n * dot(n, motion), back = vec3(0.0);
    float slide = length(along), ejected = inside ? target - gap : 0.0, away = 0.0;
    for (int turn = 0; turn < 2; ++turn) {
        vec3 from = y1 - back;
        away = through ? max(dot(n, at - from) + target - gap, 0.0) : distanceOut(c, from, n, target + depth);
        float held = min(slide, friction * max(0.0, away - ejected));
        if (turn == 1 || !(held > 0.0))
            break;
        back = along * (held / slide);
    }
    return n * away - back;
}
