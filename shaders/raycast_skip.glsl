// Empty-space skipping (CS07 section 6.2; render/raycast_skip.h): how far a ray may go on from a place without meeting anything.
// RAYCAST_SKIP: 1 by the field, 2 by the cut, 3 both. Where a lattice takes a point from is known only point by point: nothing
// is skipped there.
#ifdef RAYCAST_WARP
uniform sampler3D t_skip;           // bound on |dp/dp'|, way to what is kept (m of texture space)
uniform float u_skipReach;          // m of texture space: the bound holds to here
uniform float u_maskSlope;          // 1/m: largest of the mask
uniform vec3 u_skipHalf;            // of the box, where it is wound not beyond its own seam
uniform float u_leastStretch;       // of M's affine part, object space for 1 m
uniform float u_shareStretch;       // its largest stretch over its least
#endif

struct Skip {
    float way; // object space
    bool cut;  // all of it is cut away
};

#ifdef RAYCAST_WARP
/// Of a way in texture space from q: what is within it whichever way it goes; local space, which may be wound.
float localWay(vec3 q, float way) {
    return u_cylinder > 0.0 ? way * clamp((q.x - way) / u_cylinder + 1.0, 0.0, 1.0) : way;
}
#endif

/// Where a ray is in the box of an affine texture: entry, exit. Wound ones: all the way.
vec2 textureSlab(vec3 from, vec3 along) {
#ifdef RAYCAST_WARP
    if (u_cylinder <= 0.0) {
        vec3 a = (u_localFromObject * vec4(from, 1.0)).xyz, b = mat3(u_localFromObject) * along;
        b += vec3(equal(b, vec3(0.0))) * 1e-12;
        vec3 low = (-u_half - a) / b, high = (u_half - a) / b;
        vec3 near = min(low, high), far = max(low, high);
        vec2 range = vec2(max(near.x, max(near.y, near.z)), min(far.x, min(far.y, far.z)));
        return range.x < range.y ? range : vec2(1e30);
    }
#endif
    return vec2(-1e30, 1e30);
}

/// \param free at rest nothing is nearer, object space. \param slab of textureSlab; t: along the ray
Skip skipFrom(Warped warped, float free, float t, vec2 slab) {
    Skip skip = Skip(0.0, false);
#if defined(RAYCAST_SKIP) && !defined(RAYCAST_LATTICE)
#if RAYCAST_SKIP == 2
    free = 0.0;
#else
    free = max(free - u_fieldStep, 0.0); // of a filtered field: a voxel in doubt
#endif
#ifdef RAYCAST_WARP
    vec3 q = warped.q;
    if (!warped.inside) {
        // Things lie as at rest, up to the box.
        float box = t < slab.x ? slab.x - t : 1e30;
        if (u_cylinder > 0.0) {
            vec2 beside = max(abs(q.xy) - u_half.xy, 0.0); // the way round is not counted
            box = u_leastStretch * length(beside);
        } else if (t >= slab.x && t < slab.y) {
            box = 0.0; // on a face
        }
        skip.way = min(free, box);
        return skip;
    }
#if RAYCAST_SKIP & 2
    bool cut = warped.mask < 0.5;
#else
    const bool cut = false;
#endif
    if (!cut && free < u_step)
        return skip;
    float leave = slab.y - t;
    if (u_cylinder > 0.0) {
        vec3 face = u_skipHalf - abs(q);
        leave = u_leastStretch * localWay(q, max(min(face.x, min(face.y, face.z)), 0.0));
    }
    vec2 known = texture(t_skip, 0.5 * q / u_half + 0.5).xy;
    skip.way = min(free / (known.x * u_shareStretch), u_leastStretch * localWay(q, u_skipReach));
    if (cut) {
        float way = u_leastStretch * localWay(q, max(known.y, (0.5 - warped.mask) / u_maskSlope));
        if (way > skip.way)
            skip = Skip(way, true);
    }
    if (skip.way > leave)
        skip.way = leave;
#else
    skip.way = free;
#endif
#endif
    return skip;
}
