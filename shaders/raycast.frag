#version 450 core
// The deformation shader (CS07): a ray a pixel, warped back to rest sample by sample, until it meets the distance field there.
// RAYCAST_PROBE: what was hit, as numbers: normal and distance along the ray; rest position, kind and samples.
#include "shared_constants.h"
#include "raycast_search.glsl"
#include "lighting.glsl"
#ifndef RAYCAST_PROBE
#include "tissue_light.glsl"
#include "flesh.glsl"
#ifdef RAYCAST_VOLUME
#include "cut_volume.glsl"
#endif
#endif
#include "raycast_box.glsl"

in vec3 v_position; // object space, lattice units: on the far side of the box

uniform mat4 u_clipFromLattice;
uniform float u_behind; // so much further off lies all but faces of cuts, lattice units
#ifdef RAYCAST_STAGE
uniform float u_seamLift; // object space: the field and the surface differ by less
#endif
uniform vec3 u_inner, u_flesh; // linear: inner side of a hollow or thick one, cut faces
#ifdef RAYCAST_COLOURED
uniform sampler3D t_colours; // square root of the linear colour outside; light that arrives (render/ray_field.h)
#else
uniform vec3 u_skin; // linear: outside
#endif

#ifdef RAYCAST_PROBE
layout(location = 0) out vec4 o_normal; // xyz, t
layout(location = 1) out vec4 o_rest;   // xyz; w 1 surface, 2 its inner side, 3 cut face; 4 a sample more
#else
out vec4 o_colour;
#endif

#ifndef RAYCAST_PROBE
const float kInnerOpen = 0.8; // of the surround, in a cut
const float kVolumeRoughness = 0.42;

/// Linear colour outside at rest, and light of the surround that arrives.
vec4 skinAt(vec3 rest) {
#ifdef RAYCAST_COLOURED
    vec3 at = (rest - u_fieldLowest) / u_fieldStep;
#if RAYCAST_FIELD == SRS_FIELD_DISTANCE
    vec4 read = texture(t_colours, (at + 0.5) / vec3(textureSize(t_colours, 0)));
#else
    vec4 read = texture(t_colours, depthColourAt(at));
#endif
    return vec4(read.rgb * read.rgb, read.a);
#else
    return vec4(u_skin, 1.0);
#endif
}
#endif

/// Where the ray is in the box: entry, exit.
vec2 slab(vec3 from, vec3 along) {
    vec3 low = (boxLowest() - from) / along, high = (boxHighest() - from) / along;
    vec3 near = min(low, high), far = max(low, high);
    return vec2(max(near.x, max(near.y, near.z)), min(far.x, min(far.y, far.z)));
}

void main() {
#ifdef RAYCAST_SAMPLES
    vec3 position = interpolateAtSample(v_position, gl_SampleID); // a ray for each
#else
    vec3 position = v_position;
#endif
    vec3 along = u_eye.w > 0.0 ? normalize(position - u_eye.xyz) : -u_eye.xyz;
    along += vec3(equal(along, vec3(0.0))) * 1e-9;
    vec3 from = u_eye.w > 0.0 ? u_eye.xyz : position - length(boxHighest() - boxLowest()) * along;
    vec2 range = slab(from, along);
    range.x = max(range.x, 0.0);
    if (range.x >= range.y)
        discard;
    Hit hit = castRay(from, along, range.x, range.y);
#ifdef RAYCAST_PROBE
    if (!hit.any) { // what it cost counts, too
        gl_FragDepth = 0.9999;
        o_normal = vec4(0.0);
        o_rest = vec4(0.0, 0.0, 0.0, float(4 * hit.samples));
        return;
    }
#else
    if (!hit.any)
        discard;
#endif
    vec3 shown = from + hit.t * along, n = hitNormal(shown, hit);
    float behind = hit.face ? 0.0 : u_behind;
#ifdef RAYCAST_STAGE
    // In the seam it lies over the surface, which it covers the more the further in it is.
    float seam = smoothstep(0.0, 1.0, stageAt(shown));
    behind -= seam < 1.0 ? u_seamLift : 0.0;
#endif
    vec4 clip = u_clipFromLattice * vec4(shown + behind * along, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
#ifdef RAYCAST_PROBE
    o_normal = vec4(n, hit.t);
    o_rest = vec4(hit.rest, (hit.face ? 3.0 : hit.back ? 2.0 : 1.0) + float(4 * hit.samples));
#else
    vec3 v = -along;
    if (dot(n, v) < 0.02)
        n = normalize(n + (0.02 - dot(n, v)) * v);
    vec4 skin = skinAt(hit.rest);
    Tissue tissue;
    tissue.position = shown;
    tissue.albedo = hit.back ? u_inner : skin.rgb;
    tissue.open = hit.face || hit.back ? kInnerOpen : skin.a;
    tissue.inside = hit.back;
    tissue.normal = tissue.inside ? normalize(n + 0.8 * v) : n;
    tissue.film = n;
    tissue.roughness = 0.36;
    tissue.blood = 0.0;
    if (hit.face) {
        Flesh flesh = fleshAt(hit.rest, u_flesh);
        tissue.albedo = flesh.albedo;
        tissue.roughness = flesh.roughness;
#ifdef RAYCAST_VOLUME
        vec4 volume = cutVolumeAt(hit.rest);
        if (volume.w > 0.5) {
            tissue.albedo = volume.rgb;
            tissue.roughness = kVolumeRoughness;
        }
#endif
    }
    o_colour = vec4(tissueLight(tissue, v), 1.0);
#ifdef RAYCAST_STAGE
    o_colour.a = seam;
#endif
#endif
}
