// Is a ball empty of all that a ray may meet (CS07 section 6.2; render/raycast_skip.h)? What skipFrom of raycast_skip.glsl
// says of one ray, for all that run through the ball.
#if defined(SKIPS) && (RAYCAST_SKIP & 1)
#ifdef RAYCAST_WARP
/// Object space, of a way in texture space from q.
float objectWay(vec3 q, float way) {
    return u_leastStretch * localWay(q, way);
}

/// Of that part of the ball which the texture moves. \param q its place of the box, or the nearest one
bool isClearInside(vec3 q, Place place, float radius) {
    vec3 known = skipTexel(q * u_perSize + 0.5);
    float same = objectWay(q, abs(place.at.mask - 0.5) / u_maskSlope); // so far the mask keeps, or does not
    bool kept = place.at.mask >= 0.5;
    if (!kept && max(same, objectWay(q, known.z)) >= radius)
        return true;
#if !RAYCAST_IS_HOLLOW
    if (place.body < 0.0 && (!kept || same < radius)) // faces of cuts lie anywhere in it
        return false;
#endif
    return surfaceFree(place) >= known.y * u_shareStretch * radius && objectWay(q, u_skipReach) >= radius;
}
#endif

bool isClear(vec3 middle, float radius) {
#ifdef RAYCAST_WARP
    vec3 q = toTexture(middle), nearest = clamp(q, -0.9999 * u_half, 0.9999 * u_half), face = u_skipHalf - abs(q);
#ifdef RAYCAST_WOUND
    float enter = u_leastStretch * length(q.xy - nearest.xy); // the way round is not counted
    vec3 there = toObject(nearest);
#else
    float enter = u_leastStretch * length(q - nearest);
    vec3 there = middle + mat3(u_objectFromLocal) * (nearest - q);
#endif
    Place asIs = placeOf(Warped(middle, 1.0, true, 1e9, false, q, q * u_perSize + 0.5)); // as beyond the box
    if (enter >= radius)
        return surfaceFree(asIs) >= radius;
    Place moved = placeAt(there);
    bool clear = isClearInside(nearest, moved, radius);
    if (objectWay(q, min(face.x, min(face.y, face.z))) >= radius)
        return clear;
#ifdef RAYCAST_WOUND
    return false;
#else
    return clear && surfaceFree(asIs) >= radius && (asIs.body < 0.0) == (moved.body < 0.0);
#endif
#else
    return surfaceFree(placeAt(middle)) >= radius;
#endif
}
#else
bool isClear(vec3 middle, float radius) {
    return false;
}
#endif
