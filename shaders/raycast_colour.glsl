// Colour and light of what a ray has met (CS07 section 5): the body's outside, its inner side, faces of cuts.
#include "tissue_light.glsl"
#include "flesh.glsl"
#ifdef RAYCAST_VOLUME
#include "cut_volume.glsl"
#endif

uniform vec3 u_inner, u_flesh; // linear: inner side of a hollow or thick one, cut faces
#ifdef RAYCAST_COLOURED
uniform sampler3D t_colours; // square root of the linear colour outside; light that arrives (render/ray_field.h)
#else
uniform vec3 u_skin; // linear: outside
#endif

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

/// n: unit, outward; v: unit, to the eye.
vec3 colourOf(Hit hit, vec3 shown, vec3 n, vec3 v) {
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
    return tissueLight(tissue, v);
}
