// Signed distance to a collider's shape in its own frame: twin of sim/shape_distance.cpp and of DistanceField::sample. A
// program defines SRS_SHAPES, a bit for each SRS_SHAPE_... that it meets: others cost nothing.
#include "contact_colliders.glsl"

const real kOnCore = 1e-9; // nearer to a core no direction leads away from it

#define SRS_MEETS(shape) ((SRS_SHAPES >> (shape)) & 1)

// xyz: gradient of length 1 (on a core, where there is none, (0, 1, 0)); w: distance.
real4 aroundCore(real3 fromCore, real radius) {
    real apart = length(fromCore);
    return real4(apart > kOnCore ? fromCore / apart : real3(0.0, 1.0, 0.0), apart - radius);
}

real3 fromShank(real3 p, real side, real len) { return p - real3(0.0, side, clamp(p.z, 0.0, len)); }

#if SRS_MEETS(SRS_SHAPE_HOOK)
real3 fromHook(real3 p, real bend, real len) {
    real across = length(p.yz);
    real3 nearest = real3(0.0, p.y < 0.0 ? -bend : bend, 0.0); // beyond the half circle: its ends
    if (p.z <= 0.0)
        nearest = across > kOnCore ? real3(0.0, p.yz) * (bend / across) : real3(0.0, 0.0, -bend);
    real3 arc = p - nearest, shank = fromShank(p, -bend, len);
    return dot(shank, shank) < dot(arc, arc) ? shank : arc;
}
#endif

#if SRS_MEETS(SRS_SHAPE_BOX)
real4 aroundBox(real3 p, real3 halfSize, real radius) {
    real3 outward = abs(p) - halfSize;
    real3 side = real3(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0, p.z < 0.0 ? -1.0 : 1.0);
    real3 beyond = max(outward, 0.0);
    real apart = length(beyond);
    if (apart > kOnCore)
        return real4(side * beyond / apart, apart - radius);
    if (outward.x >= outward.y && outward.x >= outward.z) // the nearest face
        return real4(side.x, 0.0, 0.0, outward.x - radius);
    return outward.y >= outward.z ? real4(0.0, side.y, 0.0, outward.y - radius)
                                  : real4(0.0, 0.0, side.z, outward.z - radius);
}
#endif

#if SRS_MEETS(SRS_SHAPE_MESH)
// The samples of all fields, m: sample (x, y, z) of one at (its column + x, y + samples along y * z). A 2D texture, read
// sample by sample: a texture unit's own interpolation has 8 bits, and gives no gradient.
uniform sampler2D t_fields;

real fieldAt(ivec2 texel) { return real(texelFetch(t_fields, texel, 0).x); }

// `surely`: the distance is never more than it is, which beyond the grid is less near (DistanceField::lowerBound).
real4 sampleField(int c, real3 own, bool surely) {
    real spacing = b_collider[c].halfSize.x, scale = b_collider[c].halfSize.y;
    real3 lowest = b_collider[c].middle.xyz;
    ivec3 dims = ivec3(b_collider[c].kind.zw, b_collider[c].field.x);
    real3 within = clamp(own, lowest, lowest + spacing * real3(dims - 1));
    real3 at = (within - lowest) / spacing;
    ivec3 cell = clamp(ivec3(at), ivec3(0), dims - 2);
    real3 share = clamp(at - real3(cell), 0.0, 1.0);
    ivec2 first = ivec2(b_collider[c].field.y + cell.x, cell.y + dims.y * cell.z);
    real4 low, high; // at x and x + 1: (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1)
    low.x = fieldAt(first);
    low.y = fieldAt(first + ivec2(0, 1));
    low.z = fieldAt(first + ivec2(0, dims.y));
    low.w = fieldAt(first + ivec2(0, dims.y + 1));
    high.x = fieldAt(first + ivec2(1, 0));
    high.y = fieldAt(first + ivec2(1, 1));
    high.z = fieldAt(first + ivec2(1, dims.y));
    high.w = fieldAt(first + ivec2(1, dims.y + 1));
    real4 along = mix(low, high, share.x), slopes = high - low;
    real2 mixedY = mix(along.xz, along.yw, share.y), slopesX = mix(slopes.xz, slopes.yw, share.y);
    real value = mix(mixedY.x, mixedY.y, share.z) * scale;
    real3 gradient = real3(mix(slopesX.x, slopesX.y, share.z), mix(along.y - along.x, along.w - along.z, share.z),
                         mixedY.y - mixedY.x) * (scale / spacing);
    real len = length(gradient);
    gradient = len > kOnCore ? gradient / len : real3(0.0, 1.0, 0.0);
    real3 beyond = own - within; // sim/distance_field.h
    real away2 = dot(beyond, beyond);
    if (away2 > 0.0) {
        real near = max(value, 0.0);
        value = sqrt(away2 + near * near);
        if (!surely)
            value = max(value, near + dot(gradient, beyond));
        gradient = normalize(beyond + near * gradient);
    }
    return real4(gradient, value);
}
#endif

real4 sampleShape(int c, real3 own) {
    real radius = b_collider[c].size.x;
    int shape = shapeOf(c);
#if SRS_MEETS(SRS_SHAPE_CAPSULE)
    if (shape == SRS_SHAPE_CAPSULE)
        return aroundCore(fromShank(own, 0.0, b_collider[c].size.y), radius);
#endif
#if SRS_MEETS(SRS_SHAPE_BOX)
    if (shape == SRS_SHAPE_BOX)
        return aroundBox(own - b_collider[c].middle.xyz, b_collider[c].halfSize.xyz, radius);
#endif
#if SRS_MEETS(SRS_SHAPE_HOOK)
    if (shape == SRS_SHAPE_HOOK)
        return aroundCore(fromHook(own, b_collider[c].size.z, b_collider[c].size.y), radius);
#endif
#if SRS_MEETS(SRS_SHAPE_HALF_SPACE)
    if (shape == SRS_SHAPE_HALF_SPACE)
        return real4(0.0, 1.0, 0.0, own.y - radius);
#endif
#if SRS_MEETS(SRS_SHAPE_MESH)
    if (shape == SRS_SHAPE_MESH)
        return sampleField(c, own, false) - real4(0.0, 0.0, 0.0, radius);
#endif
    return aroundCore(own, radius);
}

/// Never more than the distance, for what leaves out all that is far.
real shapeLowerBound(int c, real3 own) {
#if SRS_MEETS(SRS_SHAPE_MESH)
    if (shapeOf(c) == SRS_SHAPE_MESH)
        return sampleField(c, own, true).w - b_collider[c].size.x;
#endif
    return sampleShape(c, own).w;
}
