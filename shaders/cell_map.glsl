// A place in a cell of the lattice, carried by the cell's corners (trilinear). A normal turns with the inverse transpose of the
// cell's Jacobian J, up to length J's cofactors (Barr 1984, Global and local deformations of solid primitives).
#include "side_node.glsl"

vec3 cornerAt(uint texel) {
    return followedNode(texel).xyz;
}

/// \param low, high texels y << 16 | x of the corners (at +x if c & 1, +y if c & 2, +z if c & 4). \param f from the lowest one, 0 .. 1.
/// \param n normal at rest
Mapped mapInCell(uvec4 low, uvec4 high, vec3 f, vec3 n) {
    vec3 p0 = cornerAt(low.x);
    // Relative to one corner: smaller numbers, so less is rounded off
    vec3 p1 = cornerAt(low.y) - p0, p2 = cornerAt(low.z) - p0, p3 = cornerAt(low.w) - p0;
    vec3 p4 = cornerAt(high.x) - p0, p5 = cornerAt(high.y) - p0, p6 = cornerAt(high.z) - p0,
         p7 = cornerAt(high.w) - p0;
    vec3 x0 = f.x * p1, x1 = mix(p2, p3, f.x), x2 = mix(p4, p5, f.x), x3 = mix(p6, p7, f.x); // along x
    vec3 y0 = mix(x0, x1, f.y), y1 = mix(x2, x3, f.y);
    vec3 dx = mix(mix(p1, p3 - p2, f.y), mix(p5 - p4, p7 - p6, f.y), f.z), dy = mix(x1 - x0, x3 - x2, f.z), dz = y1 - y0;

    Mapped mapped;
    mapped.position = p0 + mix(y0, y1, f.z);
    mapped.normal = n.x * cross(dy, dz) + n.y * cross(dz, dx) + n.z * cross(dx, dy);
    mapped.normal = dot(mapped.normal, mapped.normal) > 0.0 ? normalize(mapped.normal) : n; // a cell without volume
    mapped.dynamicNormal = mapped.normal;
    vec3 z = cross(dx, dy); // J's columns made orthonormal, the first one's direction kept
    mapped.axes = dot(z, z) > 0.0 ? mat3(normalize(dx), normalize(cross(z, dx)), normalize(z)) : mat3(1.0);
    mapped.turn = mat3(dx, dy, dz);
    return mapped;
}
