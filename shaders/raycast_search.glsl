// Ray traversal and intersections (CS07 sections 3.1, 5.1). Twin of castRay in render/raycast_twin.cpp.
//
// RAYCAST_SOLID: hollow, solid or a shell. Hollow: the first place where the field changes its sign and the mask keeps; others
// are passed by. Solid and shell: the first place where the ray comes to matter, which is where the body's field is negative and
// the mask keeps; where the body's field was negative before, it is a face of the cut. A shell's field is eq. 7 in our sign,
// max(f, -thickness - f): both of its sides are exact, where eq. 7 as printed jumps at half of the thickness.
#include "raycast_constants.h"
#include "raycast_warp.glsl"

uniform float u_step;      // between samples, object space
uniform float u_threshold; // SRS_SEARCH_THRESHOLD: nearer to the surface than this (object space) steps are short
uniform float u_thickness; // of a shell, object space
uniform float u_boxSize;   // longer than any way through the box: the distance where there is no tissue

struct Place {
    float distance, body, mask; // signed distance of the surface; the same of the body that is drawn
    vec3 rest;
    float cut; // to the nearest blade's cut, object space
};

Place placeAt(vec3 shown) {
    Warped warped = warp(shown);
    float f = field(warped.rest), body = f;
#if RAYCAST_SOLID == SRS_SOLID_SHELL
    body = max(f, -u_thickness - f);
#endif
    if (!warped.covered)
        f = body = u_boxSize;
    return Place(f, body, warped.mask, warped.rest, warped.cut);
}

struct Hit {
    bool any, face, back; // face: of a cut; back: the inner side of a hollow surface
    float t;
    vec3 rest;
    int samples;
};

/// Of the next step: eq. 4, clamped where it grows without bound, or by the threshold (Hadwiger et al. 2005).
/// The lip of a blade's cut is a wedge between surface and cut: short steps where both are near, or in the cut and one is.
float stepFrom(vec3 shown, vec3 along, Place place) {
    float body = place.body, lip = place.mask < 0.5 ? place.cut : max(abs(body), place.cut);
    float most = max(0.25 * lip, SRS_LIP_STEP * u_step);
#if RAYCAST_SEARCH == SRS_SEARCH_JACOBIAN
    return min(most, u_step * clamp(1.0 / max(length(warpJacobian(shown) * along), 1e-6), SRS_LEAST_STEP, SRS_MOST_STEP));
#elif RAYCAST_SEARCH == SRS_SEARCH_THRESHOLD
    return min(most, abs(body) < u_threshold ? 0.25 * u_step : u_step);
#else
    return min(most, u_step);
#endif
}

bool matter(Place place) {
    return place.body < 0.0 && place.mask >= 0.5;
}

/// Is tissue entered far from its surface, although the body's field was not negative before? In an opened cut the field is that
/// of one side or the other, as it would go on there.
bool entersInside(Place place) {
#ifdef RAYCAST_CUT
    return place.body < -0.05 * u_step;
#else
    return false;
#endif
}
#ifdef RAYCAST_STAGE
#include "stage_box.glsl"

float stageAt(vec3 shown) {
#ifdef RAYCAST_LATTICE
    shown += readLattice(shown).xyz;
#endif
    return stageDepth(shown);
}
#endif

Hit castRay(vec3 from, vec3 along, float start, float end) {
    Hit hit = Hit(false, false, false, end, vec3(0.0), 0);
    float t = start;
    Place before = placeAt(from + t * along);
    while (t < end && hit.samples < SRS_MOST_SAMPLES) {
        float next = min(t + stepFrom(from + t * along, along, before), end);
        Place now = placeAt(from + next * along);
        ++hit.samples;
#if RAYCAST_SOLID == SRS_SOLID_HOLLOW
        bool crossed = (before.body < 0.0) != (now.body < 0.0);
#else
        bool crossed = !matter(before) && matter(now);
#endif
#ifdef RAYCAST_STAGE
        // What lies beyond the box is the surface pass's.
        crossed = crossed && stageAt(from + t * along) >= 0.0 && stageAt(from + next * along) >= 0.0;
#endif
        if (crossed) {
            float low = t, high = next;
            Place out_ = before, in_ = now;
            for (int i = 0; i < SRS_BISECTIONS; ++i) {
                float middle = 0.5 * (low + high);
                Place at = placeAt(from + middle * along);
#if RAYCAST_SOLID == SRS_SOLID_HOLLOW
                bool beyond = (at.body < 0.0) == (now.body < 0.0);
#else
                bool beyond = matter(at);
#endif
                if (beyond) {
                    high = middle;
                    in_ = at;
                } else {
                    low = middle;
                    out_ = at;
                }
            }
#if RAYCAST_SOLID == SRS_SOLID_HOLLOW
            bool meant = in_.mask >= 0.5 && !entersInside(in_);
            hit.back = now.body >= 0.0;
#else
            bool meant = true;
            hit.face = out_.body < 0.0 || entersInside(in_);
#if RAYCAST_SOLID == SRS_SOLID_SHELL
            hit.back = !hit.face && in_.distance < -0.5 * u_thickness;
#endif
#endif
            if (meant) {
                hit.any = true;
                hit.t = high;
                hit.rest = in_.rest;
                return hit;
            }
        }
        t = next;
        before = now;
    }
    return hit;
}

/// Unit, outward of what was hit: eq. 5; of a cut's face against the mask's gradient (eq. 6 reads |f| < epsilon: here the
/// search knows which of the two it met).
vec3 hitNormal(vec3 shown, Hit hit) {
    vec3 mask = hit.face ? maskGradient(shown) : vec3(0.0);
    if (mask != vec3(0.0)) // there is none where tissue ends that nothing cut
        return normalize(-mask);
    vec3 normal = normalize(transpose(warpJacobian(shown)) * fieldGradient(hit.rest));
    return hit.back ? -normal : normal;
}
