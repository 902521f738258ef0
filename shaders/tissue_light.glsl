// Light on wet tissue, in two layers: flesh with a rough lobe, and a film over it that mirrors the room and lets through the rest
// (Fresnel on the way in and out; Weidlich and Wilkie 2007, Arbitrarily Layered Micro-Facet Surfaces). Under the film light
// scatters: diffuse light is wrapped around the terminator, farthest for red, since blood scatters red farthest (as in
// d'Eon and Luebke 2007, GPU Gems 3, 14). Shadows: the lamp's depth map (lamp_shadow.glsl), or balls.
#include "lamp_shadow.glsl"

struct Tissue {
    vec3 position;   // lattice units
    vec3 normal;     // of the flesh, unit
    vec3 film;       // of what is wet on it
    vec3 albedo;     // linear
    float roughness; // of the flesh
    float open;      // light of the surround that arrives
    float blood;     // 0..1: of the film
    bool inside;     // seen through a cut: light comes through the tissue from all around
};

uniform vec4 u_tools[SRS_MAX_TOOLS]; // centre, radius in lattice units
uniform int u_toolCount;
uniform sampler2D t_occlusion; // of the picture: light of the surround that reaches a pixel
uniform bool u_occlusion;

/// Light that tools leave: x of the surround, y of the key lamp.
vec2 toolShade(vec3 position, vec3 n) {
    vec2 light = vec2(1.0);
    for (int i = 0; i < u_toolCount; ++i) {
        float radius = u_tools[i].w;
        vec3 to = u_tools[i].xyz - position;
        float distance2 = max(dot(to, to), radius * radius), distance = sqrt(distance2);
        light.x *= 1.0 - max(dot(n, to) / distance, 0.0) * radius * radius / distance2;
        float along = dot(to, u_toKey), miss = sqrt(max(dot(to, to) - along * along, 0.0));
        float blur = 0.15 * radius + 0.25 * max(along, 0.0);
        light.y *= along > 0.0 ? smoothstep(radius - blur, radius + blur, miss) : 1.0;
    }
    return light;
}

vec3 tissueLight(Tissue t, vec3 v) {
    vec3 n = t.normal;
    vec2 shade = toolShade(t.position, t.film);
    // What faces away from the lamp has no shadow to get: its light came through the tissue.
    float facing = smoothstep(-0.05, 0.30, dot(t.film, u_toKey));
    if (u_shadows && !t.inside)
        shade.y = facing > 0.0 ? mix(1.0, lampLight(t.position, t.film), facing) : 1.0;
    if (u_occlusion)
        t.open *= texelFetch(t_occlusion, ivec2(gl_FragCoord.xy), 0).x;
    float open = t.open * shade.x, ndl = dot(n, u_toKey), ndv = max(dot(t.film, v), 0.02);
    float mirror = mix(0.028, 0.045, t.blood);

    const vec3 kWrap = vec3(0.40, 0.13, 0.08);
    vec3 key = max((ndl + kWrap) / ((1.0 + kWrap) * (1.0 + kWrap)), 0.0);
    key *= mix(vec3(1.0), vec3(shade.y), vec3(0.80, 0.93, 0.95)); // some red light gets under a shadow
    key *= (0.45 + 0.55 * t.open) * (t.inside ? 0.6 : 1.0);
#ifndef SURFACE_NODES
    key *= (1.0 - fresnel(mirror, max(ndl, 0.3))) * 1.03; // what the film lets in; light that was scattered came in elsewhere
#endif
    vec3 occluded = vec3(sqrt(open), open, open); // and into the grooves
    vec3 around = mix(surround(n), 0.5 * (surround(vec3(0.0, 1.0, 0.0)) + surround(vec3(0.0, -1.0, 0.0))), 0.35);
    float back = max((dot(n, u_toBack) + 0.25) / 1.56, 0.0) * open;
    vec3 colour = t.albedo * (kKeyColour * key * (1.75 * u_key) + around * 0.85 * occluded +
                              kBackColour * (0.35 * u_key * back));

#ifndef SURFACE_NODES // eq. 3 on the lattice's steps is too rough to shine
    vec3 h = normalize(v + u_toKey);
    float ldh = max(dot(u_toKey, h), 0.0), lit = max(ndl, 0.0) * shade.y * u_key * t.open * (t.inside ? 0.2 : 1.0);
    colour += kKeyColour * (0.09 * lit * ggx(t.roughness * t.roughness, max(dot(n, h), 0.0), ldh));
    colour *= (1.0 - fresnel(mirror, ndv)) * 1.03; // 1.03: as bright as without a film, seen from straight above
    colour += studio(reflect(-v, t.film), mix(0.1, 0.03, t.blood)) *
              (fresnel(mirror, ndv) * open * open * mix(0.45, 1.0, shade.y) * (t.inside ? 0.3 : 1.0));
#endif
    float grey = dot(colour, vec3(0.2126, 0.7152, 0.0722)); // blood's pure red is paler in bright light
    return toneMap(mix(colour, vec3(grey), 0.06 + 0.1 * clamp(grey, 0.0, 1.0)));
}
