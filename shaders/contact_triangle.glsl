// Contact of a triangle with a collider during a step, in the collider's own frame: twin of sim/contact_triangle.cpp.
#include "contact_point.glsl"

struct Corners {
    vec3 a, b, c;
};

vec3 weigh(Corners p, vec3 weights) { return weights.x * p.a + weights.y * p.b + weights.z * p.c; }

float longestEdge(Corners p) { return max(max(distance(p.a, p.b), distance(p.b, p.c)), distance(p.c, p.a)); }

/// The vector in the triangle's plane along which the interpolated depth grows.
vec3 depthGradient(Corners p, vec3 depth) {
    vec3 e = p.b - p.a, f = p.c - p.a;
    float ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), det = ee * ff - ef * ef;
    if (!(det > 1e-6 * ee * ff))
        return vec3(0.0);
    float a = depth.y - depth.x, b = depth.z - depth.x;
    return ((a * ff - b * ef) * e + (b * ee - a * ef) * f) / det;
}

/// Where along from..to lies what is nearest to p: 0 to 1.
float alongEdge(vec3 p, vec3 from, vec3 to) {
    vec3 edge = to - from;
    float length2 = dot(edge, edge);
    return length2 > 0.0 ? clamp(dot(p - from, edge) / length2, 0.0, 1.0) : 0.0;
}

/// Weights of the triangle's point that is nearest to p.
vec3 closestOnTriangle(vec3 p, Corners t) {
    vec3 ab = t.b - t.a, ac = t.c - t.a, normal = cross(ab, ac), ap = p - t.a;
    float whole = dot(normal, normal);
    if (whole > 0.0) {
        float wb = dot(cross(ap, ac), normal) / whole, wc = dot(cross(ab, ap), normal) / whole;
        if (wb >= 0.0 && wc >= 0.0 && wb + wc <= 1.0)
            return vec3(1.0 - wb - wc, wb, wc);
    }
    float s = alongEdge(p, t.a, t.b);
    vec3 best = vec3(1.0 - s, s, 0.0);
    vec3 apart = p - weigh(t, best);
    float nearest = dot(apart, apart);
    s = alongEdge(p, t.a, t.c);
    vec3 other = vec3(1.0 - s, 0.0, s);
    apart = p - weigh(t, other);
    if (dot(apart, apart) < nearest) {
        nearest = dot(apart, apart);
        best = other;
    }
    s = alongEdge(p, t.b, t.c);
    other = vec3(0.0, 1.0 - s, s);
    apart = p - weigh(t, other);
    return dot(apart, apart) < nearest ? other : best;
}

/// Corners, edge middles and centroid.
vec3 startWeights(int i) {
    if (i < 3)
        return vec3(i == 0, i == 1, i == 2);
    return i == 6 ? vec3(1.0 / 3.0) : vec3(i != 4, i != 5, i != 3) * 0.5;
}

/// xyz: weights of the point with the least gap; w: this gap.
vec4 deepestPoint(int c, Corners p, vec3 depth) {
    vec4 best = vec4(0.0), sampled = vec4(0.0);
    for (int i = 0; i < 7; ++i) {
        vec3 weights = startWeights(i);
        vec4 here = sampleShape(c, weigh(p, weights));
        float gap = here.w - dot(weights, depth);
        if (i == 0 || gap < best.w) {
            best = vec4(weights, gap);
            sampled = here;
        }
    }
    vec3 uphill = depthGradient(p, depth);
    float least = 0.25 * longestEdge(p);
    vec3 at = weigh(p, best.xyz);
    for (int i = 0; i < SRS_TRIANGLE_ITERATIONS; ++i) {
        float stride = max(abs(sampled.w + b_collider[c].size.x), least);
        vec3 weights = closestOnTriangle(at - stride * (sampled.xyz - uphill), p);
        vec3 next = weigh(p, weights), moved = next - at;
        if (dot(moved, moved) < 1e-12)
            break;
        at = next;
        sampled = sampleShape(c, at);
        float gap = sampled.w - dot(weights, depth);
        if (gap < best.w + kClose) // float32 does not see the last steps' gain, but a later point is better
            best = vec4(weights, gap);
    }
    return best;
}

/// The move of the triangle's point with `weights`; zero: no contact.
vec3 triangleContact(int c, Corners y0, Corners y1, vec3 depth, out vec3 weights) {
    float path = max(max(distance(y0.a, y1.a), distance(y0.b, y1.b)), distance(y0.c, y1.c));
    int samples = sweepSamples(path, thinOf(c));
    vec4 deepest = vec4(0.0);
    float s = 1.0; // the end first, then from the start on
    for (int look = 0, k = 0; look <= SRS_SWEEP_SAMPLES; ++look) {
        Corners there = y1;
        if (look > 0)
            there = Corners(y0.a + s * (y1.a - y0.a), y0.b + s * (y1.b - y0.b), y0.c + s * (y1.c - y0.c));
        deepest = deepestPoint(c, there, depth);
        if (deepest.w < 0.0 || samples == 1)
            break;
        if (look > 0)
            k += max(1, int(min(deepest.w * float(samples) / path, float(samples)))); // apart until then
        if (k >= samples)
            break;
        s = float(k) / float(samples);
    }
    weights = deepest.xyz;
    if (!(deepest.w < 0.0))
        return vec3(0.0);
    return pointContact(c, weigh(y0, weights), weigh(y1, weights), dot(weights, depth), samples);
}
