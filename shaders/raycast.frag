#version 450 core
// The deformation shader (CS07): a ray a pixel, warped back to rest sample by sample, until it meets the distance field there.
// RAYCAST_PROBE: what was hit, as numbers: normal and distance along the ray; kind and rest position.
#include "raycast_search.glsl"
#include "lighting.glsl"
#include "raycast_box.glsl"

in vec3 v_position; // object space, lattice units: on the far side of the box

uniform mat4 u_clipFromLattice;
#ifdef RAYCAST_STAGE
uniform float u_seamLift; // object space: the field and the surface differ by less
#endif
uniform vec3 u_skin, u_inner, u_flesh; // linear: outside, inner side of a hollow or thick one, cut faces

#ifdef RAYCAST_PROBE
layout(location = 0) out vec4 o_normal; // xyz, t
layout(location = 1) out vec4 o_rest;   // xyz; w 1 surface, 2 its inner side, 3 cut face
#else
out vec4 o_colour;
#endif

/// Where the ray is in the box: entry, exit.
vec2 slab(vec3 from, vec3 along) {
    vec3 low = (boxLowest() - from) / along, high = (boxHighest() - from) / along;
    vec3 near = min(low, high), far = max(low, high);
    return vec2(max(near.x, max(near.y, near.z)), min(far.x, min(far.y, far.z)));
}

void main() {
    vec3 along = u_eye.w > 0.0 ? normalize(v_position - u_eye.xyz) : -u_eye.xyz;
    along += vec3(equal(along, vec3(0.0))) * 1e-9;
    vec3 from = u_eye.w > 0.0 ? u_eye.xyz : v_position - length(boxHighest() - boxLowest()) * along;
    vec2 range = slab(from, along);
    range.x = max(range.x, 0.0);
    if (range.x >= range.y)
        discard;
    Hit hit = castRay(from, along, range.x, range.y);
    if (!hit.any)
        discard;
    vec3 shown = from + hit.t * along, n = hitNormal(shown, hit);
#ifdef RAYCAST_STAGE
    // In the seam it lies over the surface, which it covers the more the further in it is.
    float seam = smoothstep(0.0, 1.0, stageAt(shown));
    vec4 clip = u_clipFromLattice * vec4(shown - (seam < 1.0 ? u_seamLift : 0.0) * along, 1.0);
#else
    vec4 clip = u_clipFromLattice * vec4(shown, 1.0);
#endif
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
#ifdef RAYCAST_PROBE
    o_normal = vec4(n, hit.t);
    o_rest = vec4(hit.rest, hit.face ? 3.0 : hit.back ? 2.0 : 1.0);
#else
    vec3 v = -along, albedo = hit.face ? u_flesh : hit.back ? u_inner : u_skin;
    if (dot(n, v) < 0.02)
        n = normalize(n + (0.02 - dot(n, v)) * v);
    float ndl = dot(n, u_toKey), ndv = max(dot(n, v), 0.02);
    const vec3 kWrap = vec3(0.40, 0.13, 0.08);
    vec3 key = max((ndl + kWrap) / ((1.0 + kWrap) * (1.0 + kWrap)), 0.0);
    float back = max((dot(n, u_toBack) + 0.25) / 1.56, 0.0);
    vec3 colour = albedo * (kKeyColour * key * (1.75 * u_key) + surround(n) * 0.75 + kBackColour * (0.35 * u_key * back));
    vec3 h = normalize(v + u_toKey);
    colour += kKeyColour * (0.09 * max(ndl, 0.0) * u_key * ggx(0.13, max(dot(n, h), 0.0), max(dot(u_toKey, h), 0.0)));
    colour += studio(reflect(-v, n), 0.1) * fresnel(0.028, ndv);
    o_colour = vec4(toneMap(colour), 1.0);
#ifdef RAYCAST_STAGE
    o_colour.a = seam;
#endif
#endif
}
