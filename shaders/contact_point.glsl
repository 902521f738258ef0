// Contact of one material point with a collider during a step, in the collider's own frame: twin of
// sim/contact_point.cpp, which says what is done and why.
#include "shape_distance.glsl"

const real kEndless = 1e30;

real contactDepthFor(real depth, real thin) { return max(depth, -real(0.5) * thin); }

int sweepSamples(real path, real thin) {
    return clamp(int(min(ceil(path / (0.5 * thin)), real(SRS_SWEEP_SAMPLES))), 1, SRS_SWEEP_SAMPLES);
}

/// Least t >= 0 with phi(p + t n) >= target.
real distanceOut(int c, real3 p, real3 n, real target) {
    real t = 0.0, low = 0.0, high = kEndless;
    for (int i = 0; i < 40; ++i) {
        real4 there = sampleShape(c, p + t * n);
        real gap = there.w - target, slope = dot(there.xyz, n);
        if ((i == 0 && gap >= 0.0) || abs(gap) < 1e-12)
            return t;
        if (gap < 0.0)
            low = t;
        else
            high = t;
        real next = slope > 0.01 ? t - gap / slope : t + abs(gap);
        if (!(next > low && next < high))
            next = high < kEndless ? real(0.5) * (low + high) : t + abs(gap);
        if (!(next > low && next < high)) // the bracket is one rounding wide
            break;
        t = next;
    }
    return high < kEndless ? high : t;
}

real3 onTheWay(real3 y0, real3 y1, real s) { return s == 1.0 ? y1 : y0 + s * (y1 - y0); }

/// What moves the point out at the step's end; zero where nothing touches.
real3 pointContact(int c, real3 y0, real3 y1, real depth, int samples) {
    real4 start = sampleShape(c, y0);
    real endGap = sampleShape(c, y1).w - depth, gap = start.w - depth, target = 0.0;
    bool any = false, through = false, inside = gap < 0.0;
    real3 at = y0, n = start.xyz;
    if (inside) {
        target = min(real(0.0), gap + SRS_EJECTION);
        any = endGap < target;
    }
    // First touch on the way; inside: does it go deeper on the way and come out again?
    real limit = inside ? gap : 0.0, before = 0.0, touched = 1.0;
    int last = inside ? samples - 1 : samples;
    for (int k = 1; k <= last && !any; ++k) {
        touched = k == samples ? 1.0 : real(k) / real(samples);
        real here = k == samples ? endGap : sampleShape(c, onTheWay(y0, y1, touched)).w - depth;
        any = here < limit;
        if (!any)
            before = touched;
    }
    if (!any)
        return real3(0.0);
    if (inside) {
        through = !(endGap < target);
    } else {
        through = touched < 1.0 && endGap >= 0.0;
        for (int i = 0; i < SRS_SWEEP_BISECTIONS; ++i) {
            real middle = real(0.5) * (before + touched);
            if (sampleShape(c, onTheWay(y0, y1, middle)).w - depth < 0.0)
                touched = middle;
            else
                before = middle;
        }
        at = onTheWay(y0, y1, before);
        real4 there = sampleShape(c, at);
        n = there.xyz;
        gap = there.w - depth;
    }
    // The way out, then friction's share of the motion, and the way out from there.
    real friction = b_collider[c].from.w;
    real3 motion = y1 - y0, along = motion - n * dot(n, motion), back = real3(0.0);
    real slide = length(along), ejected = inside ? target - gap : 0.0, away = 0.0;
    for (int turn = 0; turn < 2; ++turn) {
        real3 from = y1 - back;
        away = through ? max(dot(n, at - from) + ejected, real(0.0)) : distanceOut(c, from, n, target + depth);
        real held = min(slide, friction * max(real(0.0), away - ejected));
        if (turn == 1 || !(held > 0.0))
            break;
        back = along * (held / slide);
    }
    return n * away - back;
}
