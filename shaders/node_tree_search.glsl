// The first triangle on a ray and the one closest to a point, through the tree of node_tree.glsl. Of several equally near
// the one of the lowest index. Twins: TriangleTree (sim/triangle_tree.cpp), in double.
//
// Ray against triangle: Woop, Benthin & Wald 2013 (watertight: the products of an edge are the same for both of its
// triangles, so none is fused). Closest point: Ericson 2005, section 5.1.5.
//
// The entry point provides vec3 treePosition(uint texel), lattice units.
#include "node_tree.glsl"

struct TreeHit {
    uint triangle;  // index; SRS_TREE_NONE: nothing in reach
    vec2 weights;   // of its first two nodes
    float distance; // along the ray in lengths of its direction; or from the point
};

/// The vector with its longest component in `longest` last.
vec3 turnedTo(vec3 v, vec3 longest) {
    vec3 size = abs(longest);
    return size.x > size.y ? (size.x > size.z ? v.yzx : v) : (size.y > size.z ? v.zxy : v);
}

TreeHit treeCast(vec3 origin, vec3 direction, float reach) {
    TreeHit best = TreeHit(SRS_TREE_NONE, vec2(0.0), reach);
    TreeRay ray = makeTreeRay(origin, direction);
    vec3 along = turnedTo(direction, direction);
    float inverse = 1.0 / along.z;
    vec2 shear = along.xy * inverse;
    TreeCursor cursor = treeBegin();
    for (int leaf = treeNextOnRay(cursor, ray, best.distance); leaf >= 0;
         leaf = treeNextOnRay(cursor, ray, best.distance)) {
        for (int i = 0; i < SRS_TREE_LEAF; ++i) {
            uvec4 triangle = b_treeTriangle[leaf * SRS_TREE_LEAF + i];
            if (triangle.w == SRS_TREE_NONE)
                break;
            precise vec3 a = turnedTo(treePosition(triangle.x) - origin, direction);
            precise vec3 b = turnedTo(treePosition(triangle.y) - origin, direction);
            precise vec3 c = turnedTo(treePosition(triangle.z) - origin, direction);
            precise vec2 p = a.xy - shear * a.z, q = b.xy - shear * b.z, r = c.xy - shear * c.z;
            precise float u = r.x * q.y - r.y * q.x, v = p.x * r.y - p.y * r.x, w = q.x * p.y - q.y * p.x;
            bool outside = min(u, min(v, w)) < 0.0 && max(u, max(v, w)) > 0.0;
            float sum = u + v + w;
            if (outside || sum == 0.0)
                continue;
            vec3 weights = vec3(u, v, w) / sum;
            float t = inverse * dot(weights, vec3(a.z, b.z, c.z));
            if (t >= 0.0 && (t < best.distance || (t == best.distance && triangle.w < best.triangle)))
                best = TreeHit(triangle.w, weights.xy, t);
        }
    }
    return best;
}

/// Weights of the point of the edge a, b closest to p = 0, and its squared distance.
vec3 closestOnEdge(vec3 a, vec3 b) {
    vec3 edge = b - a;
    float share = clamp(-dot(a, edge) / max(dot(edge, edge), 1e-30), 0.0, 1.0);
    vec3 at = a + share * edge;
    return vec3(1.0 - share, share, dot(at, at));
}

/// Weights of the point of the triangle a, b, c closest to the origin.
vec3 closestOnTriangle(vec3 a, vec3 b, vec3 c) {
    vec3 ab = b - a, ac = c - a;
    float d1 = -dot(ab, a), d2 = -dot(ac, a), d3 = -dot(ab, b), d4 = -dot(ac, b), d5 = -dot(ab, c), d6 = -dot(ac, c);
    float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2, sum = va + vb + vc;
    if (sum > 0.0 && va >= 0.0 && vb >= 0.0 && vc >= 0.0)
        return vec3(va, vb, vc) / sum;
    // On the border, or a sliver: the nearest of three edges (corners are their ends).
    vec3 onAb = closestOnEdge(a, b), onBc = closestOnEdge(b, c), onCa = closestOnEdge(c, a);
    return onAb.z <= onBc.z && onAb.z <= onCa.z ? vec3(onAb.xy, 0.0)
           : onBc.z <= onCa.z                   ? vec3(0.0, onBc.xy)
                                                : vec3(onCa.y, 0.0, onCa.x);
}

/// No further than `reach`.
TreeHit treeClosest(vec3 point, float reach) {
    TreeHit best = TreeHit(SRS_TREE_NONE, vec2(0.0), reach);
    TreeCursor cursor = treeBegin();
    for (int leaf = treeNextInSphere(cursor, point, best.distance); leaf >= 0;
         leaf = treeNextInSphere(cursor, point, best.distance)) {
        for (int i = 0; i < SRS_TREE_LEAF; ++i) {
            uvec4 triangle = b_treeTriangle[leaf * SRS_TREE_LEAF + i];
            if (triangle.w == SRS_TREE_NONE)
                break;
            vec3 a = treePosition(triangle.x) - point, b = treePosition(triangle.y) - point,
                 c = treePosition(triangle.z) - point;
            vec3 weights = closestOnTriangle(a, b, c);
            float away = length(weights.x * a + weights.y * b + weights.z * c);
            if (away < best.distance || (away == best.distance && triangle.w < best.triangle))
                best = TreeHit(triangle.w, weights.xy, away);
        }
    }
    return best;
}
