#version 450 core
// The deformation shader (CS07): a ray a pixel, warped back to rest sample by sample, until it meets the distance field there.
// RAYCAST_PROXY: the way through a tetrahedron that the vertex stage has moved, of which rest is an affine map.
// RAYCAST_PROBE: what was hit, as numbers: normal and distance along the ray; rest position, kind and samples.
#include "shared_constants.h"
#include "raycast_search.glsl"
#include "lighting.glsl"
#ifndef RAYCAST_PROBE
#include "raycast_colour.glsl"
#endif
#include "raycast_box.glsl"
#ifdef RAYCAST_PROXY
#include "raycast_proxy.glsl"
#endif

#ifndef RAYCAST_PROXY
in vec3 v_position; // object space, lattice units: on the far side of the box
#endif

uniform mat4 u_clipFromLattice;
uniform float u_behind; // so much further off lies all but faces of cuts, lattice units
#ifdef RAYCAST_STAGE
uniform float u_seamLift; // object space: the field and the surface differ by less
#endif

#ifdef RAYCAST_PROBE
layout(location = 0) out vec4 o_normal; // xyz, t
layout(location = 1) out vec4 o_rest;   // xyz; w 1 surface, 2 its inner side, 3 cut face; 4 a sample more
#else
out vec4 o_colour;
#endif

/// Where the ray is in the box: entry, exit.
vec2 slab(vec3 from, vec3 along) {
    vec3 low = (boxLowest() - from) / along, high = (boxHighest() - from) / along;
    vec3 near = min(low, high), far = max(low, high);
    return vec2(max(near.x, max(near.y, near.z)), min(far.x, min(far.y, far.z)));
}

struct Met {
    Hit hit;          // t: from `from` on
    vec3 from, along; // of the ray
    vec3 at;          // where it was searched: shown, or as the vertex stage leaves that at rest
};

/// \param position object space, on the ray: any in front of the eye
Met meet(vec3 position) {
    vec3 along = u_eye.w > 0.0 ? normalize(position - u_eye.xyz) : -u_eye.xyz;
    along += vec3(equal(along, vec3(0.0))) * 1e-9;
#ifdef RAYCAST_PROXY
    vec3 from = u_eye.xyz;
    if (u_eye.w == 0.0)
        from = position + (slab(position, along).y - length(boxHighest() - boxLowest())) * along;
    float beside = dot(v_corner - from, along);
    Way way = wayThrough(from + beside * along, along, beside);
    if (way.end <= 0.0)
        discard;
    Hit hit = castRay(way.from, way.along, 0.0, way.end);
    vec3 at = way.from + hit.t * way.along;
    hit.t = beside + way.start + hit.t / way.stretch;
#else
    vec3 from = u_eye.w > 0.0 ? u_eye.xyz : position - length(boxHighest() - boxLowest()) * along;
    vec2 range = slab(from, along);
    range.x = max(range.x, 0.0);
    if (range.x >= range.y)
        discard;
    Hit hit = castRay(from, along, range.x, range.y);
    vec3 at = from + hit.t * along;
#endif
    return Met(hit, from, along, at);
}

void show(Met met) {
    Hit hit = met.hit;
    vec3 shown = met.from + hit.t * met.along, n = hitNormal(met.at, hit);
#ifdef RAYCAST_PROXY
    n = normalShown(n, met.at);
#endif
    float behind = hit.face ? 0.0 : u_behind;
#ifdef RAYCAST_STAGE
    // In the seam it lies over the surface, which it covers the more the further in it is.
    float seam = smoothstep(0.0, 1.0, stageAt(shown));
    behind -= seam < 1.0 ? u_seamLift : 0.0;
#endif
    vec4 clip = u_clipFromLattice * vec4(shown + behind * met.along, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
#ifdef RAYCAST_PROBE
    o_normal = vec4(n, hit.t);
    o_rest = vec4(hit.rest, (hit.face ? 3.0 : hit.back ? 2.0 : 1.0) + float(4 * hit.samples));
#else
    o_colour = vec4(colourOf(hit, shown, n, -met.along), 1.0);
#ifdef RAYCAST_STAGE
    o_colour.a = seam;
#endif
#endif
}

void main() {
#ifdef RAYCAST_PROXY
    Met met = meet(pixelPlace());
#elif defined(RAYCAST_SAMPLES)
    Met met = meet(interpolateAtSample(v_position, gl_SampleID)); // a ray for each
#else
    Met met = meet(v_position);
#endif
#ifdef RAYCAST_PROBE
    gl_FragDepth = 0.9999; // what met nothing costs, too
    o_normal = vec4(0.0);
    o_rest = vec4(0.0, 0.0, 0.0, float(4 * met.hit.samples));
#else
    if (!met.hit.any)
        discard;
#endif
    // Most ways through a tetrahedron meet nothing. A software renderer runs through what a branch holds, but not through a loop.
    for (int i = 0; i < int(met.hit.any); ++i)
        show(met);
}
