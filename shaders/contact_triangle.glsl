// Contact of a triangle with a collider during a step, in the collider's own frame: twin of sim/contact_triangle.cpp.
#include "contact_point.glsl"

struct Corners {
    dvec3 a, b, c;
};

dvec3 weigh(Corners p, dvec3 weights) { return weights.x * p.a + weights.y * p.b + weights.z * p.c; }

double longestEdge(Corners p) { return max(max(distance(p.a, p.b), distance(p.b, p.c)), distance(p.c, p.a)); }

/// The vector in the triangle's plane along which the interpolated depth grows.
dvec3 depthGradient(Corners p, dvec3 depth) {
    dvec3 e = p.b - p.a, f = p.c - p.a;
    double ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), det = ee * ff - ef * ef;
    if (!(det > 1e-12 * ee * ff))
        return dvec3(0.0);
    double a = depth.y - depth.x, b = depth.z - depth.x;
    return ((a * ff - b * ef) * e + (b * ee - a * ef) * f) / det;
}

/// Where along from..to lies what is nearest to p: 0 to 1.
double alongEdge(dvec3 p, dvec3 from, dvec3 to) {
    dvec3 edge = to - from;
    double length2 = dot(edge, edge);
    return length2 > 0.0 ? clamp(dot(p - from, edge) / length2, 0.0lf, 1.0lf) : 0.0;
}

/// Weights of the triangle's point that is nearest to p.
dvec3 closestOnTriangle(dvec3 p, Corners t) {
    dvec3 ab = t.b - t.a, ac = t.c - t.a, normal = cross(ab, ac), ap = p - t.a;
    double whole = dot(normal, normal);
    if (whole > 0.0) {
        double wb = dot(cross(ap, ac), normal) / whole, wc = dot(cross(ab, ap), normal) / whole;
        if (wb >= 0.0 && wc >= 0.0 && wb + wc <= 1.0)
            return dvec3(1.0 - wb - wc, wb, wc);
    }
    double s = alongEdge(p, t.a, t.b);
    dvec3 best = dvec3(1.0 - s, s, 0.0);
    dvec3 apart = p - weigh(t, best);
    double nearest = dot(apart, apart);
    s = alongEdge(p, t.a, t.c);
    dvec3 other = dvec3(1.0 - s, 0.0, s);
    apart = p - weigh(t, other);
    if (dot(apart, apart) < nearest) {
        nearest = dot(apart, apart);
        best = other;
    }
    s = alongEdge(p, t.b, t.c);
    other = dvec3(0.0, 1.0 - s, s);
    apart = p - weigh(t, other);
    return dot(apart, apart) < nearest ? other : best;
}

/// Corners, edge middles and centroid.
dvec3 startWeights(int i) {
    if (i < 3)
        return dvec3(i == 0, i == 1, i == 2);
    return i == 6 ? dvec3(1.0lf / 3.0lf) : dvec3(i != 4, i != 5, i != 3) * 0.5;
}

/// xyz: weights of the point with the least gap; w: this gap.
dvec4 deepestPoint(int c, Corners p, dvec3 depth) {
    dvec4 best = dvec4(0.0), sampled = dvec4(0.0);
    for (int i = 0; i < 7; ++i) {
        dvec3 weights = startWeights(i);
        dvec4 here = sampleShape(c, weigh(p, weights));
        double gap = here.w - dot(weights, depth);
        if (i == 0 || gap < best.w) {
            best = dvec4(weights, gap);
            sampled = here;
        }
    }
    dvec3 uphill = depthGradient(p, depth);
    double least = 0.25lf * longestEdge(p);
    dvec3 at = weigh(p, best.xyz);
    double stretch = 1.0;
    for (int i = 0; i < SRS_TRIANGLE_ITERATIONS; ++i) {
        double stride = stretch * max(abs(sampled.w + b_collider[c].size.x), least);
        dvec3 weights = closestOnTriangle(at - stride * (sampled.xyz - uphill), p);
        dvec3 next = weigh(p, weights), moved = next - at;
        if (dot(moved, moved) < 1e-16)
            break;
        dvec4 here = sampleShape(c, next);
        double gap = here.w - dot(weights, depth);
        if (gap < best.w) {
            best = dvec4(weights, gap);
            at = next;
            sampled = here;
            stretch *= 2.0lf;
        } else {
            stretch *= 0.25lf;
        }
    }
    return best;
}

/// Does the collider lie on the inner side of the triangle, in front of the point with `weights`?
bool meetsFromInside(int c, Corners p, dvec3 weights) {
    dvec3 outward = cross(p.b - p.a, p.c - p.a);
    return dot(sampleShape(c, weigh(p, weights)).xyz, outward) > 0.5lf * length(outward);
}

/// The move of the triangle's point with `weights`; zero: no contact.
dvec3 triangleContact(int c, Corners y0, Corners y1, dvec3 surfaceDepth, out dvec3 weights) {
    dvec3 depth = surfaceDepth;
    double path = max(max(distance(y0.a, y1.a), distance(y0.b, y1.b)), distance(y0.c, y1.c));
    int samples = sweepSamples(path, thinOf(c));
    dvec4 deepest = deepestPoint(c, y1, depth);
    bool inside = meetsFromInside(c, y0, deepest.xyz);
    if (inside)
        depth = max(depth, dvec3(SRS_WALL));
    double s = 1.0; // the end first, then from the start on
    for (int look = 0, k = 0; look <= SRS_SWEEP_SAMPLES; ++look) {
        Corners there = y1;
        if (look > 0)
            there = Corners(y0.a + s * (y1.a - y0.a), y0.b + s * (y1.b - y0.b), y0.c + s * (y1.c - y0.c));
        if (look > 0 || inside)
            deepest = deepestPoint(c, there, depth);
        if (deepest.w < 0.0 || samples == 1)
            break;
        if (look > 0)
            k += max(1, int(min(deepest.w * double(samples) / path, double(samples)))); // apart until then
        if (k >= samples)
            break;
        s = double(k) / double(samples);
    }
    weights = deepest.xyz;
    if (!(deepest.w < 0.0))
        return dvec3(0.0);
    return pointContact(c, weigh(y0, weights), weigh(y1, weights), dot(weights, depth), samples);
}
