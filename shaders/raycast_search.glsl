// Ray traversal and intersections (CS07 sections 3.1, 5.1). Twin of castRay in render/raycast_twin.cpp.
//
// RAYCAST_SOLID: hollow, solid or a shell. Hollow: the first place where the field changes its sign and the mask keeps; others
// are passed by. Solid and shell: the first place where the ray comes to matter, which is where the body's field is negative and
// the mask keeps; where the body's field was negative before, it is a face of the cut.
// Combined: hollow as section 5.1.1 warns of it: the zeros of one implicit, object minus cut, of which those of the cut are passed by.
// What of the object is thinner beside the cut than a step has no sample, and is missed.
// RAYCAST_GRADIENT: normals from the deformed field's gradient (section 3.3), not by eq. 5.
#include "raycast_step.glsl"

struct Hit {
    bool any, face, back; // face: of a cut; back: the inner side of a hollow surface
    float t;
    vec3 rest;
    int samples;
};

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
    int most = int(clamp(SRS_SAMPLES_A_STEP * (end - start) / u_step, SRS_MOST_SAMPLES, SRS_MOST_OF_ALL));
    vec2 slab = textureSlab(from, along);
    float t = start, last = start;
    Place place = placeAt(from + t * along);
    Side before = sideOf(place), now = before;
    Advance go = advanceFrom(place, from + t * along, along, t, slab);
    // Searching and refining are loops of their own: a software renderer runs through what a branch holds. For the same
    // reason no place is kept from one turn to the next, but what is asked of it.
    while (!hit.any && t < end && hit.samples < most) {
        bool found = false;
        while (!found && t < end && hit.samples < most) {
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
            Advance then = advanceFrom(place, shown, along, t, slab);
#ifdef SKIPS
            if (go.by > go.sure && go.clear + then.clear < t - last) { // anything may lie between: back
                found = false;
                t = last;
                now = before;
                then = Advance(go.sure, go.sure, go.clear, go.cut);
            }
#endif
            go = then;
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
            hit.back = !inside(above);
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

#ifdef RAYCAST_GRADIENT
/// Of f'(p') = f(p), over as much as fieldGradient: six warps, where eq. 5 reads D around one place.
vec3 deformedGradient(vec3 shown) {
    vec3 by = vec3(u_fieldStep, 0.0, 0.0);
    return vec3(field(warp(shown + by.xyy).rest) - field(warp(shown - by.xyy).rest),
                field(warp(shown + by.yxy).rest) - field(warp(shown - by.yxy).rest),
                field(warp(shown + by.yyx).rest) - field(warp(shown - by.yyx).rest));
}
#endif

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
