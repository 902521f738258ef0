// How far a ray may go on from a place without meeting anything (CS07 section 6.2; render/raycast_skip.h), and how far it may go
// for its samples to lie no further apart at rest than a step.
// RAYCAST_SKIP: 1 by the field, 2 by the cut, 3 both. Where a lattice takes a point from is known only point by point: nothing
// is skipped there.
#if defined(RAYCAST_SKIP) && !defined(RAYCAST_LATTICE)
#define SKIPS
#endif
#if defined(SKIPS) && defined(RAYCAST_WARP)
uniform sampler3D t_skip;     // bounds on |dp/dp'|, near and within reach; way to what is kept (m of texture space)
uniform float u_skipNear;     // m of texture space: the first bound holds to here,
uniform float u_skipReach;    // and the second
uniform float u_maskSlope;    // 1/m: largest of the mask
uniform vec3 u_skipHalf;      // of the box, where it is wound not beyond its own seam
uniform float u_leastStretch; // of M's affine part, object space for 1 m
uniform float u_shareStretch; // its largest stretch over its least

/// Of the nearest texel: its bounds hold half a texel around it, too.
vec3 skipTexel(vec3 unit) {
    ivec3 size = textureSize(t_skip, 0);
    ivec3 at = clamp(ivec3(vec3(size) * unit), ivec3(0), size - 1);
    return texelFetch(t_skip, at, 0).xyz;
}

/// Of a way in texture space from q: what is within it whichever way it goes; local space, which may be wound.
float localWay(vec3 q, float way) {
#ifdef RAYCAST_WOUND
    return way * clamp((q.x - way) / u_cylinder + 1.0, 0.0, 1.0);
#else
    return way;
#endif
}
#endif

/// At rest the body's surface is no nearer, object space. Of a filtered field: a voxel is in doubt, and near the surface, as its
/// voxels hold a distance, it falls by no more than sqrt(3) on a way of 1.
float surfaceFree(Place place) {
    return max(place.free - u_fieldStep, 0.577 * place.free);
}

struct Skip {
    float way;     // object space: so far nothing is met, whichever way the ray goes within `most`
    float most;    // along the ray, to where that ends: in or out of the texture's box
    float stretch; // bound on |dp/dp'| here
    bool cut;      // all of the way is cut away
};

/// Where a ray is in the box of an affine texture: entry, exit. Wound ones: all the way.
vec2 textureSlab(vec3 from, vec3 along) {
#if defined(SKIPS) && defined(RAYCAST_WARP) && !defined(RAYCAST_WOUND)
    vec3 a = (u_localFromObject * vec4(from, 1.0)).xyz, b = mat3(u_localFromObject) * along;
    b += vec3(equal(b, vec3(0.0))) * 1e-12;
    vec3 low = (-u_half - a) / b, high = (u_half - a) / b;
    vec3 near = min(low, high), far = max(low, high);
    vec2 range = vec2(max(near.x, max(near.y, near.z)), min(far.x, min(far.y, far.z)));
    return range.x < range.y ? range : vec2(1e30);
#else
    return vec2(-1e30, 1e30);
#endif
}

/// \param slab of textureSlab; t: along the ray
Skip skipFrom(Place place, float t, vec2 slab) {
    Skip skip = Skip(0.0, 1e30, 1.0, false);
#ifdef SKIPS
    Warped warped = place.at;
    float free = 0.0;
#if RAYCAST_SKIP & 1
    if (RAYCAST_IS_HOLLOW || place.body >= 0.0) // faces of cuts lie anywhere in it
        free = surfaceFree(place);
#endif
    skip.way = free;
#ifdef RAYCAST_WARP
    vec3 q = warped.q, known = skipTexel(warped.unit);
#ifdef RAYCAST_WOUND
    float enter = u_leastStretch * length(max(abs(q.xy) - u_half.xy, 0.0)); // the way round is not counted
    vec3 face = u_skipHalf - abs(q);
    float leave = u_leastStretch * localWay(q, max(min(face.x, min(face.y, face.z)), 0.0));
#else
    float enter = t < slab.x ? slab.x - t : t < slab.y ? 0.0 : 1e30, leave = slab.y - t;
#endif
    if (warped.inside) {
        skip.stretch = known.x * u_shareStretch;
        float near = min(free / skip.stretch, u_leastStretch * localWay(q, u_skipNear)),
              far = min(free / (known.y * u_shareStretch), u_leastStretch * localWay(q, u_skipReach));
        skip.way = max(near, far);
#if RAYCAST_SKIP & 2
        float way = u_leastStretch * localWay(q, max(known.z, (0.5 - warped.mask) / u_maskSlope));
        if (warped.mask < 0.5 && way > skip.way) {
            skip.way = way;
            skip.cut = true;
        }
#endif
        skip.most = leave;
    } else {
        skip.most = enter; // things lie as at rest, up to the box
    }
    skip.way = min(skip.way, skip.most);
#endif
#endif
    return skip;
}
