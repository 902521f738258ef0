// What a ray finds at a place: the body's field where the place rests, and whether anything has cut it away.
// A shell's field is eq. 7 in our sign, max(f, -thickness - f): both of its sides are exact, where eq. 7 as printed jumps at half
// of the thickness.
#include "raycast_constants.h"
#define RAYCAST_SEARCHES_BODY (RAYCAST_SOLID == SRS_SOLID_HOLLOW)
#define RAYCAST_IS_HOLLOW (RAYCAST_SEARCHES_BODY || RAYCAST_SOLID == SRS_SOLID_COMBINED)
#include "raycast_field.glsl"
#include "raycast_jacobian.glsl"

uniform float u_thickness; // of a shell, object space
uniform float u_boxSize;   // longer than any way through the box: the distance where there is no tissue
uniform float u_step;      // between samples, object space

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
