// Contact of a triangle with a collider during a step, in the collider's own frame: twin of sim/contact_triangle.cpp.
#include "contact_point.glsl"

struct Corners {
    real3 a, b, c;
};

real3 weigh(Corners p, real3 weights) { return weights.x * p.a + weights.y * p.b + weights.z * p.c; }

real longestEdge(Corners p) { return max(max(distance(p.a, p.b), distance(p.b, p.c)), distance(p.c, p.a)); }

/// The vector in the triangle's plane along which the interpolated depth grows.
real3 depthGradient(Corners p, real3 depth) {
    real3 e = p.b - p.a, f = p.c - p.a;
    real ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), det = ee * ff - ef * ef;
    if (!(det > 1e-12 * ee * ff))
        return real3(0.0);
    real a = depth.y - depth.x, b = depth.z - depth.x;
    return ((a * ff - b * ef) * e + (b * ee - a * ef) * f) / det;
}

/// Where along from..to lies what is nearest to p: 0 to 1.
real alongEdge(real3 p, real3 from, real3 to) {
    real3 edge = to - from;
    real length2 = dot(edge, edge);
    return length2 > 0.0 ? clamp(dot(p - from, edge) / length2, real(0.0), real(1.0)) : 0.0;
}

/// Weights of the triangle's point that is nearest to p.
real3 closestOnTriangle(real3 p, Corners t) {
    real3 ab = t.b - t.a, ac = t.c - t.a, normal = cross(ab, ac), ap = p - t.a;
    real whole = dot(normal, normal);
    if (whole > 0.0) {
        real wb = dot(cross(ap, ac), normal) / whole, wc = dot(cross(ab, ap), normal) / whole;
        if (wb >= 0.0 && wc >= 0.0 && wb + wc <= 1.0)
            return real3(1.0 - wb - wc, wb, wc);
    }
    real s = alongEdge(p, t.a, t.b);
    real3 best = real3(1.0 - s, s, 0.0);
    real3 apart = p - weigh(t, best);
    real nearest = dot(apart, apart);
    s = alongEdge(p, t.a, t.c);
    real3 other = real3(1.0 - s, 0.0, s);
    apart = p - weigh(t, other);
    if (dot(apart, apart) < nearest) {
        nearest = dot(apart, apart);
        best = other;
    }
    s = alongEdge(p, t.b, t.c);
    other = real3(0.0, 1.0 - s, s);
    apart = p - weigh(t, other);
    return dot(apart, apart) < nearest ? other : best;
}

/// Corners, edge middles and centroid.
real3 startWeights(int i) {
    if (i < 3)
        return real3(i == 0, i == 1, i == 2);
    return i == 6 ? real3(real(1.0) / real(3.0)) : real3(i != 4, i != 5, i != 3) * 0.5;
}

/// xyz: weights of the point with the least gap; w: this gap.
real4 deepestPoint(int c, Corners p, real3 depth) {
    real4 best = real4(0.0), sampled = real4(0.0);
    for (int i = 0; i < 7; ++i) {
        real3 weights = startWeights(i);
        real4 here = sampleShape(c, weigh(p, weights));
        real gap = here.w - dot(weights, depth);
        if (i == 0 || gap < best.w) {
            best = real4(weights, gap);
            sampled = here;
        }
    }
    real3 uphill = depthGradient(p, depth);
    real least = real(0.25) * longestEdge(p);
    real3 at = weigh(p, best.xyz);
    real stretch = 1.0;
    for (int i = 0; i < SRS_TRIANGLE_ITERATIONS; ++i) {
        real stride = stretch * max(abs(sampled.w + b_collider[c].size.x), least);
        real3 weights = closestOnTriangle(at - stride * (sampled.xyz - uphill), p);
        real3 next = weigh(p, weights), moved = next - at;
        if (dot(moved, moved) < 1e-16)
            break;
        real4 here = sampleShape(c, next);
        real gap = here.w - dot(weights, depth);
        if (gap < best.w) {
            best = real4(weights, gap);
            at = next;
            sampled = here;
            stretch *= real(2.0);
        } else {
            stretch *= real(0.25);
        }
    }
    return best;
}

/// Does the collider lie on the inner side of the triangle, behind the point of it that is nearest to it?
bool fromInside(int c, Corners y0, dvec3 depth) {
    dvec3 outward = cross(y0.b - y0.a, y0.c - y0.a);
    dvec3 n = sampleShape(c, weigh(y0, deepestPoint(c, y0, depth).xyz)).xyz;
    return dot(n, outward) > 0.5lf * length(outward);
}

/// Where a triangle first touches (weights), and the gap there (w); >= 0: nowhere.
dvec4 firstTouch(int c, Corners y0, Corners y1, dvec3 depth, double path, int samples) {
    dvec4 deepest = deepestPoint(c, y1, depth);
    for (int k = 0; k < samples && samples > 1 && deepest.w >= 0.0;) {
        double s = double(k) / double(samples);
        Corners there = Corners(y0.a + s * (y1.a - y0.a), y0.b + s * (y1.b - y0.b), y0.c + s * (y1.c - y0.c));
        deepest = deepestPoint(c, there, depth);
        k += max(1, int(min(deepest.w * double(samples) / path, double(samples)))); // apart until then
    }
    return deepest;
}

/// The move of the triangle's point with `weights`; zero: no contact.
dvec3 triangleContact(int c, Corners y0, Corners y1, dvec3 surface, out dvec3 weights) {
    double path = max(max(distance(y0.a, y1.a), distance(y0.b, y1.b)), distance(y0.c, y1.c));
    int samples = sweepSamples(path, thinOf(c));
    // Most triangles do not even touch as a wall.
    dvec3 depth = max(surface, min(surface, dvec3(0.0)) + double(SRS_WALL));
    dvec4 deepest = firstTouch(c, y0, y1, depth, path, samples);
    if (deepest.w < 0.0 && !fromInside(c, y0, surface)) {
        depth = surface;
        deepest = firstTouch(c, y0, y1, depth, path, samples);
    }
    weights = deepest.xyz;
    if (!(deepest.w < 0.0))
        return dvec3(0.0);
    return pointContact(c, weigh(y0, weights), weigh(y1, weights), dot(weights, depth), samples);
}
