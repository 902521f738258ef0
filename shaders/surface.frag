#version 450 core
// Wet tissue, lit per pixel in the frame that the basis carried along from rest (tissue_light.glsl). Where a blade cut, fragments are
// discarded (SURFACE_CUT) and the inside shows as flesh. Or the dynamic normal as a colour (SURFACE_NORMAL_COLOURS), for MS05
// figure 6; or its own colour under the key lamp alone (SURFACE_PLAIN), which other renderers can draw, too.
#include "shared_constants.h"
#include "lighting.glsl"
#include "tissue_light.glsl"

in vec3 v_position;
in vec3 v_normal;
in vec3 v_dynamicNormal;
in vec4 v_colour;
#ifdef SURFACE_REST
in vec3 v_rest;
#endif
#ifdef SURFACE_CUT
#include "cut_mask.glsl"
flat in float v_side;
in float v_away;
uniform bool u_blood;
#endif
#ifdef SURFACE_BOX
#include "stage_box.glsl"
#endif
#ifdef SURFACE_TEXTURED
#include "tissue_texture.glsl"
in mat3 v_turn; // to now from rest
#endif
#ifdef SURFACE_UV
in vec2 v_uv;
in vec4 v_tangent; // at rest; w: sign of the bitangent
#endif

uniform vec4 u_section; // plane, lattice units; 0: none

out vec4 o_colour;

const vec3 kInnerColour = vec3(0.24, 0.030, 0.023); // flesh, seen through a cut
const float kInnerOpen = 0.6;                       // of the surround, in there
const vec3 kCutColour = vec3(0.42, 0.085, 0.07);    // flesh, evenly lit: one plane
const vec3 kBlood = vec3(0.090, 0.0040, 0.0030);

#ifdef SURFACE_CUT
/// 0..1: how much blood lies here, in a film that ends unevenly.
float bloodAt(vec3 rest, float distance) {
    vec3 w = 2.1 * rest;
    float ripple = 0.5 + 0.25 * (sin(w.x + 2.0 * sin(w.y)) + sin(1.7 * w.z + 2.0 * sin(w.x)));
    return 1.0 - smoothstep(0.10 + 0.25 * ripple, 0.28 + 0.55 * ripple, distance);
}
#endif

void main() {
    Tissue tissue;
    tissue.blood = 0.0;
#ifdef SURFACE_CUT
    vec4 mask = cutMask(v_rest);
    if (isCut(mask, v_side, v_away))
        discard;
    if (u_blood)
        tissue.blood = bloodAt(v_rest, mask.b * SRS_MASK_REACH);
#endif
#ifdef SURFACE_BOX
    if (stageDepth(v_rest) > 1.0)
        discard;
#endif
    // The surface is closed: where its inner side shows through a section, solid tissue has been cut.
    if (!gl_FrontFacing && u_section.xyz != vec3(0.0)) {
        o_colour = vec4(kCutColour, 1.0);
        return;
    }
    vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal), v = toEye(v_position);
    float away = dot(n, v);
    if (away < 0.02) // interpolation turns normals at the silhouette a little away from the eye
        n = normalize(n + (0.02 - away) * v);
#if defined(SURFACE_NORMAL_COLOURS)
    vec3 albedo = 0.5 + 0.5 * normalize(v_dynamicNormal);
    float shade = 0.35 + 0.5 * max(dot(n, u_toKey), 0.0) + 0.15 * max(dot(n, v), 0.0);
    o_colour = vec4(albedo * albedo * shade, 1.0);
#elif defined(SURFACE_PLAIN)
    o_colour = vec4(v_colour.rgb * (0.25 * u_ambient + 0.75 * u_key * max(dot(n, u_toKey), 0.0)), 1.0);
#else
    tissue.position = v_position;
    tissue.albedo = gl_FrontFacing ? v_colour.rgb : kInnerColour;
    tissue.open = gl_FrontFacing ? v_colour.a : kInnerOpen;
    tissue.inside = !gl_FrontFacing;
    tissue.normal = tissue.inside ? normalize(n + 0.8 * v) : n; // and is as much scattered as reflected
    tissue.film = n;
    tissue.roughness = 0.36;
#ifdef SURFACE_TEXTURED
    mat3 turn = mat3(normalize(v_turn[0]), normalize(v_turn[1]), normalize(v_turn[2]));
    vec3 restNormal = normalize(n * turn), restView = v * turn; // by its transpose
#ifdef SURFACE_UV
    Detail detail = detailOf(v_rest, restNormal, restView, v_tangent, v_uv);
#else
    Detail detail = detailOf(v_rest, restNormal, restView);
#endif
    tissue.albedo *= detail.albedo;
    tissue.open *= detail.open;
    tissue.normal = normalize(turn * detail.normal + (tissue.normal - n));
    tissue.film = normalize(n + 0.7 * tissue.normal); // the film fills the relief
    tissue.roughness = detail.roughness;
#endif
    tissue.albedo = mix(tissue.albedo, kBlood, (gl_FrontFacing ? 0.75 : 0.45) * tissue.blood);
    o_colour = vec4(tissueLight(tissue, v), 1.0);
#endif
}
