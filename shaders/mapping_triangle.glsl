// MS05 3.3, eq. 9: a vertex from three node texels and a moving basis.
//
// One formula for all bases (render/triangle_basis.h): a normal N and the triangle's first edge give B = N x T and
// T = B x N. N is the triangle's (eq. 6), the weighted mean of the nodes' (eq. 8), or a share of both; normalized, which
// eq. 6 and 8 leave out. Along N alone (3.5, SRS_MAP_NORMAL) the basis turns the rest normal only.
layout(location = 0) in uvec3 a_texels; // y << 16 | x
layout(location = 1) in vec2 a_weights; // w1, w2
#if MAPPING == SRS_MAP_NORMAL
layout(location = 2) in float a_offset; // d of v = r + d N, lattice units
#else
layout(location = 2) in vec3 a_offset; // in the basis, lattice units
#endif
#if MAPPING == SRS_MAP_BLENDED
layout(location = 11) in vec4 a_shares; // xyz: how much each node's normal counts; w: of the corrected basis
#endif

Mapped mapOwn() {
    vec4 p1 = fetchNode(a_texels.x), p2 = fetchNode(a_texels.y), p3 = fetchNode(a_texels.z);
    vec3 edge = p2.xyz - p1.xyz;
    vec2 w = a_weights;
#if MAPPING != SRS_MAP_CORRECTED
    vec3 flatNormal = cross(edge, p3.xyz - p1.xyz);
#endif
#if MAPPING != SRS_MAP_CONSTANT
    vec3 counts = vec3(w, 1.0 - w.x - w.y);
#if MAPPING == SRS_MAP_BLENDED
    counts *= a_shares.xyz; // a normal that is not well defined is not read
#endif
    vec3 mean = counts.x * nodeNormal(p1) + counts.y * nodeNormal(p2) + counts.z * nodeNormal(p3);
#endif
#if MAPPING == SRS_MAP_CONSTANT
    vec3 normal = flatNormal;
#elif MAPPING == SRS_MAP_CORRECTED
    vec3 normal = mean;
#elif MAPPING == SRS_MAP_BLENDED
    vec3 normal = normalize(flatNormal);
    if (a_shares.w > 0.0)
        normal = mix(normal, normalize(mean), a_shares.w);
#else
    vec3 normal = (a_normal & 0x40000000u) != 0u ? mean : flatNormal;
#endif
    vec3 n = normalize(normal), b = normalize(cross(n, edge)), t = cross(b, n);

    Mapped mapped;
    mapped.axes = mapped.turn = mat3(t, n, b);
    mapped.dynamicNormal = n;
    mapped.normal = mapped.axes * unpackNormal(a_normal);
    // p3 plus differences: smaller numbers than three weighted positions, so less is rounded off
    mapped.position = p3.xyz + w.x * (p1.xyz - p3.xyz) + w.y * (p2.xyz - p3.xyz);
#if MAPPING == SRS_MAP_NORMAL
    mapped.position += a_offset * n;
#else
    mapped.position += mapped.axes * a_offset;
#endif
    return mapped;
}
