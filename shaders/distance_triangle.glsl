// Closest point of a triangle (Ericson 2005, Real-time collision detection, 5.1.5), in the unit of its vertices.
layout(std430) restrict readonly buffer b_vertices { vec4 b_position[]; };
layout(std430) restrict readonly buffer b_triangles { uvec4 b_triangle[]; };

/// feature: 0 face, 1 to 3 edges 0-1, 1-2, 2-0, 4 to 6 corners. Precise: one pass looks for whose distance another found, to
/// the last bit.
vec3 closestOnTriangle(vec3 p, vec3 a, vec3 b, vec3 c, out int feature) {
    precise vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c, closest;
    precise float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
    precise float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (d1 <= 0.0 && d2 <= 0.0) {
        feature = 4;
        closest = a;
    } else if (d3 >= 0.0 && d4 <= d3) {
        feature = 5;
        closest = b;
    } else if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        feature = 1;
        closest = a + d1 / (d1 - d3) * ab;
    } else if (d6 >= 0.0 && d5 <= d6) {
        feature = 6;
        closest = c;
    } else if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        feature = 3;
        closest = a + d2 / (d2 - d6) * ac;
    } else if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        feature = 2;
        closest = b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
    } else {
        precise float whole = 1.0 / (va + vb + vc);
        feature = 0;
        closest = a + ab * (vb * whole) + ac * (vc * whole);
    }
    return closest;
}

vec3 closestOf(uint triangle, vec3 p, out int feature) {
    uvec3 t = b_triangle[triangle].xyz;
    return closestOnTriangle(p, b_position[t.x].xyz, b_position[t.y].xyz, b_position[t.z].xyz, feature);
}
