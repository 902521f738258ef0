// How far a ray goes on from a place: by what it skips (section 6.2), by the adaptive step (eq. 4) and by what the picture shows
// (section 6.3).
#include "raycast_place.glsl"
#include "raycast_skip.glsl"

uniform float u_threshold; // SRS_SEARCH_THRESHOLD: nearer to the surface than this (object space) steps are short

/// The lip of a blade's cut is a wedge between surface and cut: short steps where both are near, or in the cut and one is.
float mostStep(Place place) {
#ifdef RAYCAST_CUT
    float lip = place.at.mask < 0.5 ? place.at.cut : max(abs(place.body), place.at.cut);
    return max(0.25 * lip, SRS_LIP_STEP * u_step);
#else
    return 1e30;
#endif
}

uniform vec4 u_pixel; // its width at a place, object space
#ifdef RAYCAST_COARSE
uniform float u_coarse;        // share of a pixel, and of a frame's way on the screen
uniform mat4 u_beforeFromNow;  // object space: where what is in the texture's box was a frame ago
#endif
#ifdef RAYCAST_PROXY
// Of a way through a tetrahedron, which is searched as the vertex stage leaves it at rest.
float wayPixel = 0.0;   // width of a pixel there
float wayStretch = 1.0; // at rest, of one shown: even steps are even in what is shown
#endif

/// The step before it adapts. CS07 section 6.3: what is small on the screen or moves fast on it has fewer samples. A sample
/// need not be nearer than the picture shows: half a pixel, or half of the way that a place takes in a frame.
float baseStep(vec3 shown, vec3 along, Place place) {
    float base = u_step;
#ifdef RAYCAST_COARSE
#ifdef RAYCAST_PROXY
    float seen = wayPixel;
#else
    float seen = dot(u_pixel, vec4(shown, 1.0));
#endif
#ifdef RAYCAST_LATTICE
    seen = max(seen, b_way);
#endif
    vec3 way = shown - (u_beforeFromNow * vec4(shown, 1.0)).xyz;
    if (place.at.inside)
        seen = max(seen, length(way - dot(way, along) * along));
    base = clamp(u_coarse * seen, u_step, SRS_MOST_COARSE * u_step);
#endif
#if defined(RAYCAST_PROXY) && RAYCAST_SEARCH != SRS_SEARCH_JACOBIAN
    base *= wayStretch;
#endif
    return base;
}

/// Of the next step: eq. 4, clamped where it grows without bound, or by the threshold (Hadwiger et al. 2005). Where space is
/// skipped a bound on the Jacobian is known: no matter how the ray runs, samples lie no further apart at rest.
float searchStep(vec3 shown, vec3 along, float body, float stretch, float base) {
#if RAYCAST_SEARCH == SRS_SEARCH_JACOBIAN
#ifndef SKIPS
    stretch = length(warpJacobian(shown) * along);
#endif
    return base * clamp(1.0 / max(stretch, 1e-6), SRS_LEAST_STEP, SRS_MOST_STEP);
#elif RAYCAST_SEARCH == SRS_SEARCH_THRESHOLD
    return abs(body) < u_threshold ? 0.25 * base : base;
#else
    return base;
#endif
}

struct Advance {
    float by;    // object space
    float sure;  // so far, at least, no look ahead is needed
    float clear; // nothing is met within this, to either side
    bool cut;    // all of the way is cut away
};

/// How far a ray goes on from a place. What is clear around it ends before what is clear around the next place begins, if
/// that is further off: a ray goes on by more than is clear, and goes back where the two do not touch (Keinert et al. 2014,
/// Enhanced Sphere Tracing).
Advance advanceFrom(Place place, vec3 shown, vec3 along, float t, vec2 slab) {
    Skip skip = skipFrom(place, t, slab);
    float next = searchStep(shown, along, place.body, skip.stretch, baseStep(shown, along, place));
    float sure = max(skip.way, min(next, mostStep(place)));
    float ahead = skip.cut ? 0.0 : min(SRS_AHEAD * skip.way, skip.most);
    return Advance(max(sure, ahead), sure, skip.way, skip.cut && sure <= skip.way);
}
