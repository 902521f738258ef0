// Symmetric 3x3 matrices: the diagonal, and xy, yz, zx.
struct Symmetric {
    vec3 d, o;
};
Symmetric dyad(vec3 v) { return Symmetric(v * v, v * v.yzx); }
Symmetric scaled(float s, Symmetric m) { return Symmetric(s * m.d, s * m.o); }
void addTo(inout Symmetric sum, Symmetric m) {
    sum.d += m.d;
    sum.o += m.o;
}
vec3 times(Symmetric m, vec3 v) {
    return vec3(m.d.x * v.x + m.o.x * v.y + m.o.z * v.z, m.o.x * v.x + m.d.y * v.y + m.o.y * v.z,
                m.o.z * v.x + m.o.y * v.y + m.d.z * v.z);
}

/// Of a positive matrix, made a little more so (Symmetric3::inverse).
Symmetric inverseOf(Symmetric m) {
    float most = max(m.d.x, max(m.d.y, m.d.z));
    if (!(most > 0.0))
        return Symmetric(vec3(0.0), vec3(0.0));
    vec3 root = inversesqrt(m.d + SRS_IMPLICIT_REGULAR * most);
    vec3 o = m.o * root * root.yzx;
    float determinant = 1.0 - dot(o, o) + 2.0 * o.x * o.y * o.z;
    float s = 1.0 / max(determinant, SRS_IMPLICIT_REGULAR);
    return Symmetric(s * root * root * (1.0 - o.yzx * o.yzx), s * root * root.yzx * (o.yzx * o.zxy - o));
}
