#version 450 core
// Wet tissue, lit per pixel with the rest normal that the basis carried along: wrapped diffuse light that turns red at the
// terminator (blood scatters red farthest), a rough lobe of the tissue and a sharp one of the film on it, soft surroundings.
// Or (SURFACE_NORMAL_COLOURS) the dynamic normal as a colour, for MS05 figure 6.
#include "shared_constants.h"
#include "lighting.glsl"

in vec3 v_position;
in vec3 v_normal;
in vec3 v_dynamicNormal;
in vec4 v_colour;

uniform vec4 u_tools[SRS_MAX_TOOLS]; // centre, radius in lattice units
uniform int u_toolCount;
uniform vec4 u_section; // plane, lattice units; 0: none

out vec4 o_colour;

const vec3 kCutColour = vec3(0.42, 0.085, 0.07); // flesh, evenly lit: one plane

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

void main() {
    // The surface is closed: where its inner side shows through a section, solid tissue has been cut.
    if (!gl_FrontFacing && u_section.xyz != vec3(0.0)) {
        o_colour = vec4(kCutColour, 1.0);
        return;
    }
    vec3 n = normalize(v_normal), v = toEye(v_position);
    float away = dot(n, v);
    if (away < 0.02) // interpolation turns normals at the silhouette a little away from the eye
        n = normalize(n + (0.02 - away) * v);
#ifdef SURFACE_NORMAL_COLOURS
    vec3 albedo = 0.5 + 0.5 * normalize(v_dynamicNormal);
    float shade = 0.35 + 0.5 * max(dot(n, u_toKey), 0.0) + 0.15 * max(dot(n, v), 0.0);
    o_colour = vec4(albedo * albedo * shade, 1.0);
#else
    vec3 albedo = v_colour.rgb;
    vec2 shade = toolShade(v_position, n);
    float open = v_colour.a * shade.x, ndl = dot(n, u_toKey), ndv = max(dot(n, v), 0.02);

    const vec3 kWrap = vec3(0.40, 0.13, 0.08);
    vec3 key = max((ndl + kWrap) / ((1.0 + kWrap) * (1.0 + kWrap)), 0.0);
    key *= mix(vec3(1.0), vec3(shade.y), vec3(0.80, 0.93, 0.95)); // some red light gets under the tool's shadow
    key *= 0.45 + 0.55 * v_colour.a;
    vec3 occluded = vec3(sqrt(open), open, open); // and into the grooves
    float back = max((dot(n, u_toBack) + 0.25) / 1.56, 0.0) * open;
    vec3 colour = albedo * (kKeyColour * key * (1.75 * u_key) + surround(n) * 0.75 * occluded +
                            kBackColour * (0.35 * u_key * back));

#ifndef SURFACE_NODES // eq. 3 on the lattice's steps is too rough to shine
    // The tissue's own rough lobe, then the film: what a sharp mirror sees, by Fresnel.
    vec3 h = normalize(v + u_toKey);
    float ndh = max(dot(n, h), 0.0), ldh = max(dot(u_toKey, h), 0.0);
    colour += kKeyColour * (0.09 * max(ndl, 0.0) * shade.y * u_key * ggx(0.13, ndh, ldh) * v_colour.a);
    colour += studio(reflect(-v, n), 0.1) * (fresnel(0.028, ndv) * open * open * mix(0.45, 1.0, shade.y));
#endif
    float grey = dot(colour, vec3(0.2126, 0.7152, 0.0722)); // blood's pure red is paler in bright light
    o_colour = vec4(toneMap(mix(colour, vec3(grey), 0.06 + 0.1 * clamp(grey, 0.0, 1.0))), 1.0);
#endif
}
