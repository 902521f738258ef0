// Closest point of a triangle (Ericson 2005, Real-time collision detection, 5.1.5), in the unit of its vertices.
layout(std430) restrict readonly buffer b_vertices { vec4 b_position[]; };
layout(std430) restrict readonly buffer b_triangles { uvec4 b_triangle[]; };

/// feature: 0 face, 1 to 3 edges 0-1, 1-2, 2-0, 4 to 6 corners.
vec3 closestOnTriangle(vec3 p, vec3 a, vec3 b, vec3 c, out int feature) {
    vec3 ab = b - a, ac = c - a, ap = p - a;
    float d1 = dot(ab, ap), d2 = dot(ac, ap);
    feature = 4;
    if (d1 <= 0.0 && d2 <= 0.0)
        return a;
    vec3 bp = p - b;
    float d3 = dot(ab, bp), d4 = dot(ac, bp);
    feature = 5;
    if (d3 >= 0.0 && d4 <= d3)
        return b;
    float vc = d1 * d4 - d3 * d2;
    feature = 1;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0)
        return a + d1 / (d1 - d3) * ab;
    vec3 cp = p - c;
    float d5 = dot(ab, cp), d6 = dot(ac, cp);
    feature = 6;
    if (d6 >= 0.0 && d5 <= d6)
        return c;
    float vb = d5 * d2 - d1 * d6;
    feature = 3;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0)
        return a + d2 / (d2 - d6) * ac;
    float va = d3 * d6 - d5 * d4;
    feature = 2;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
    feature = 0;
    float whole = 1.0 / (va + vb + vc);
    return a + ab * (vb * whole) + ac * (vc * whole);
}

vec3 closestOf(uint triangle, vec3 p, out int feature) {
    uvec3 t = b_triangle[triangle].xyz;
    return closestOnTriangle(p, b_position[t.x].xyz, b_position[t.y].xyz, b_position[t.z].xyz, feature);
}
