// The point of a triangle that is closest to the origin, as weights of its corners; triangles without an area, too.

float alongEdge(vec3 a, vec3 b) {
    vec3 edge = b - a;
    return clamp(-dot(a, edge) / max(dot(edge, edge), 1e-30), 0.0, 1.0);
}

vec3 closestWeights(vec3 a, vec3 b, vec3 c) {
    float s = alongEdge(a, b), t = alongEdge(a, c), r = alongEdge(b, c);
    vec3 ab = mix(a, b, s), ac = mix(a, c, t), bc = mix(b, c, r);
    float toAb = dot(ab, ab), toAc = dot(ac, ac), toBc = dot(bc, bc);
    vec3 edge = toAb <= toAc && toAb <= toBc ? vec3(1.0 - s, s, 0.0)
                : toAc <= toBc               ? vec3(1.0 - t, 0.0, t)
                                             : vec3(0.0, 1.0 - r, r);
    vec3 normal = cross(b - a, c - a);
    float area2 = dot(normal, normal);
    // Signed areas of the triangles with the origin's projection.
    vec3 areas = vec3(dot(cross(b, c), normal), dot(cross(c, a), normal), dot(cross(a, b), normal));
    bool within = area2 > 1e-12 && all(greaterThanEqual(areas, vec3(0.0)));
    return within ? areas / (areas.x + areas.y + areas.z) : edge;
}
