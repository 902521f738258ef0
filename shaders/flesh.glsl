// Cut muscle as a solid texture: bundles of fibres with fat between them and a few vessels, at a rest position (lattice units),
// so that it is cut with the tissue and moves with it. Value noise of hashed grid points (Perlin 1985's solid texture).

float hashed(ivec3 p) {
    uint h = uint(p.x) * 0x8da6b343u ^ uint(p.y) * 0xd8163841u ^ uint(p.z) * 0xcb1ab31fu;
    h = (h ^ h >> 13) * 0x9e3779b1u;
    return float(h >> 8) / 16777215.0;
}

float valueNoise(vec3 at) {
    vec3 cell = floor(at), s = at - cell;
    s = s * s * (3.0 - 2.0 * s);
    ivec3 p = ivec3(cell);
    vec4 low = vec4(hashed(p), hashed(p + ivec3(1, 0, 0)), hashed(p + ivec3(0, 1, 0)), hashed(p + ivec3(1, 1, 0)));
    vec4 high = vec4(hashed(p + ivec3(0, 0, 1)), hashed(p + ivec3(1, 0, 1)), hashed(p + ivec3(0, 1, 1)), hashed(p + ivec3(1)));
    vec4 z = mix(low, high, s.z);
    vec2 y = mix(z.xy, z.zw, s.y);
    return mix(y.x, y.y, s.x);
}

struct Flesh {
    vec3 albedo;
    float roughness;
};

/// \param colour of the muscle, linear
Flesh fleshAt(vec3 rest, vec3 colour) {
    // Fibres run along y and waver; bundles are wide across them and eight times as long.
    vec3 bent = rest + 0.6 * vec3(valueNoise(0.5 * rest + 7.0), 0.0, valueNoise(0.5 * rest + 31.0));
    float bundle = valueNoise(bent * vec3(1.6, 0.2, 1.6)), fibre = valueNoise(bent * vec3(7.0, 0.5, 7.0) + 13.0);
    float fat = smoothstep(0.66, 0.80, valueNoise(bent * vec3(0.9, 0.25, 0.9) + 53.0) + 0.12 * fibre);
    float vessel = valueNoise(bent * vec3(1.3, 0.35, 1.3) + 97.0);
    float wall = smoothstep(0.035, 0.015, abs(vessel - 0.86)), lumen = smoothstep(0.86, 0.88, vessel);
    vec3 albedo = colour * (0.62 + 0.45 * bundle + 0.35 * fibre);
    albedo = mix(albedo, vec3(0.62, 0.42, 0.20), 0.75 * fat);
    albedo = mix(albedo, vec3(0.55, 0.22, 0.18), 0.6 * wall);
    albedo = mix(albedo, vec3(0.10, 0.006, 0.005), lumen);
    return Flesh(albedo, mix(0.42, 0.30, fat));
}
