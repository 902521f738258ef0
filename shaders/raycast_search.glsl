// Ray traversal and intersections (CS07 sections 3.1, 5.1). Twin of castRay in render/raycast_twin.cpp.
//
// RAYCAST_SOLID: hollow, solid or a shell. Hollow: the first place where the field changes its sign and the mask keeps; others
// are passed by. Solid and shell: the first place where the ray comes to matter, which is where the body's field is negative and
// the mask keeps; where the body's field was negative before, it is a face of the cut. A shell's field is eq. 7 in our sign,
// max(f, -thickness - f): both of its sides are exact, where eq. 7 as printed jumps at half of the thickness.
// Combined: hollow as section 5.1.1 warns of it: the zeros of one implicit, object minus cut, of which those of the cut are passed by.
// What of the object is thinner beside the cut than a step has no sample, and is missed.
// RAYCAST_GRADIENT: normals from the deformed field's gradient (section 3.3), not by eq. 5.
#include "raycast_constants.h"
#define RAYCAST_SEARCHES_BODY (RAYCAST_SOLID == SRS_SOLID_HOLLOW)
#define RAYCAST_IS_HOLLOW (RAYCAST_SEARCHES_BODY || RAYCAST_SOLID == SRS_SOLID_COMBINED)
#include "raycast_warp.glsl"

uniform float u_step;      // between samples, object space
uniform float u_threshold; // SRS_SEARCH_THRESHOLD: nearer to the surface than this (object space) steps are short
uniform float u_thickness; // of a shell, object space
uniform float u_boxSize;   // longer than any way through the box: the distance where there is no tissue
#include "raycast_skip.glsl"

struct Place {
    float distance, body, free; // signed distance of the surface; of the body that is drawn; least way to it
    Warped at;
};

Place placeOf(Warped warped) {
    vec2 parts = fieldParts(warped.rest);
    float f = parts.x + parts.y, body = f;
#if RAYCAST_SOLID == SRS_SOLID_SHELL
    body = max(f, -u_thickness - f);
#endif
    // Beyond a volume: no nearer than its edge, and what is in it lies across.
    float free = parts.y <= 0.0 ? abs(body) : parts.x > 0.0 ? length(parts) : 0.0;
    if (!warped.covered)
        f = body = u_boxSize;
    return Place(f, body, free, warped);
}

Place placeAt(vec3 shown) {
    return placeOf(warp(shown));
}

struct Hit {
    bool any, face, back; // face: of a cut; back: the inner side of a hollow surface
    float t;
    vec3 rest;
    int samples;
};

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

/// Of a place, what tells whether a ray meets something on its way to the next.
struct Side {
    float body; // its field
    bool kept;  // nothing has cut it away
};

Side sideOf(Place place) {
    return Side(place.body, place.at.mask >= 0.5);
}

bool inside(Side side) {
    return side.body < 0.0;
}

bool matter(Side side) {
    return inside(side) && side.kept;
}

/// Is tissue entered far from its surface, although the body's field was not negative before? In an opened cut the field is that
/// of one side or the other, as it would go on there.
bool entersInside(Side side) {
#ifdef RAYCAST_CUT
    return side.body < -0.05 * u_step;
#else
    return false;
#endif
}

#ifdef RAYCAST_STAGE
#include "stage_box.glsl"

float stageAt(vec3 shown) {
#ifdef RAYCAST_LATTICE
    shown = moveBack(shown).rest;
#endif
    return stageDepth(shown);
}
#endif

/// Has the ray met something between two places?
bool crossed(Side before, Side now) {
#if RAYCAST_SEARCHES_BODY
    return inside(before) != inside(now);
#elif RAYCAST_SOLID == SRS_SOLID_COMBINED
    return matter(before) != matter(now);
#else
    return !matter(before) && matter(now);
#endif
}

struct Advance {
    float by; // object space
    bool cut; // all of the way is cut away
};

/// How far a ray goes on from a place.
Advance advanceFrom(Place place, vec3 shown, vec3 along, float t, vec2 slab) {
    Skip skip = skipFrom(place.at, place.free, t, slab);
    float next = searchStep(shown, along, place.body, skip.stretch, baseStep(shown, along, place));
    float by = max(skip.way, min(next, mostStep(place)));
    return Advance(by, skip.cut && by <= skip.way);
}

/// Where an interval in which a ray meets something is looked at next: where the secant has the field's zero, a little before it
/// and then a little beyond, so that the interval closes around it; and every third time in the middle, which needs no straight field.
float refinedPlace(int i, float low, float high, Side below, Side above) {
    float share = below.body / (below.body - above.body);
    bool straight = i % 3 < 2 && below.kept && above.kept && inside(below) != inside(above);
    float by = (i % 3 == 0 ? -0.45 : 0.45) * SRS_EXACT * u_step;
    float secant = clamp(mix(low, high, share) + by, low, high);
    return straight ? secant : 0.5 * (low + high);
}

Hit castRay(vec3 from, vec3 along, float start, float end) {
    Hit hit = Hit(false, false, false, end, vec3(0.0), 0);
    vec2 slab = textureSlab(from, along);
    float t = start, last = start;
    Place place = placeAt(from + t * along);
    Side before = sideOf(place), now = before;
    Advance go = advanceFrom(place, from + t * along, along, t, slab);
    // Searching and refining are loops of their own: a software renderer runs through what a branch holds. For the same
    // reason no place is kept from one turn to the next, but what is asked of it.
    while (!hit.any && t < end && hit.samples < SRS_MOST_SAMPLES) {
        bool found = false;
        while (!found && t < end && hit.samples < SRS_MOST_SAMPLES) {
            before = now;
            last = t;
            t = min(t + go.by, end);
            vec3 shown = from + t * along;
            place = placeAt(shown);
            ++hit.samples;
            now = sideOf(place);
            found = crossed(before, now);
#if RAYCAST_IS_HOLLOW
            found = found && !go.cut; // what is cut away is not looked at
#endif
#ifdef RAYCAST_STAGE
            // What lies beyond the box is the surface pass's.
            found = found && stageAt(from + last * along) >= 0.0 && stageAt(shown) >= 0.0;
#endif
            go = advanceFrom(place, shown, along, t, slab);
        }
        float low = last, high = t;
        Side below = before, above = now;
        for (int i = 0; found && i < SRS_REFINEMENTS && high - low > SRS_EXACT * u_step; ++i) {
            float middle = refinedPlace(i, low, high, below, above);
            Side at = sideOf(placeAt(from + middle * along));
            if (crossed(before, at)) {
                high = middle;
                above = at;
            } else {
                low = middle;
                below = at;
            }
        }
        if (found) {
            Place met = placeAt(from + high * along);
#if RAYCAST_SEARCHES_BODY
            hit.any = above.kept && !entersInside(above);
            hit.back = !inside(now);
#elif RAYCAST_SOLID == SRS_SOLID_COMBINED
            hit.any = inside(below) != inside(above) && !entersInside(above);
            hit.back = !inside(above);
#else
            hit.any = true;
            hit.face = inside(below) || entersInside(above);
#if RAYCAST_SOLID == SRS_SOLID_SHELL
            hit.back = !hit.face && met.distance < -0.5 * u_thickness;
#endif
#endif
            hit.t = high;
            hit.rest = met.at.rest;
        }
    }
    return hit;
}

/// Unit, outward of what was hit: eq. 5; of a cut's face against the mask's gradient (eq. 6 reads |f| < epsilon: here the
/// search knows which of the two it met).
vec3 hitNormal(vec3 shown, Hit hit) {
    vec3 mask = hit.face ? maskGradient(shown) : vec3(0.0);
    if (mask != vec3(0.0)) // there is none where tissue ends that nothing cut
        return normalize(-mask);
#ifdef RAYCAST_GRADIENT
    vec3 normal = normalize(deformedGradient(shown));
#else
    vec3 normal = normalize(transpose(warpJacobian(shown)) * fieldGradient(hit.rest));
#endif
    return hit.back ? -normal : normal;
}
