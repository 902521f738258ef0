// Signed distance to a collider's shape in its own frame: twin of sim/shape_distance.cpp and of DistanceField::sample. A
// program defines SRS_SHAPES, a bit for each SRS_SHAPE_... that it meets: others cost nothing.
#include "contact_colliders.glsl"

#define SRS_MEETS(shape) ((SRS_SHAPES >> (shape)) & 1)

// xyz: gradient of length 1 (on a core, where there is none, (0, 1, 0)); w: distance.
vec4 aroundCore(vec3 fromCore, float radius) {
    float apart = length(fromCore);
    return vec4(apart > 1e-6 ? fromCore / apart : vec3(0.0, 1.0, 0.0), apart - radius);
}

vec3 fromShank(vec3 p, float side, float len) { return p - vec3(0.0, side, clamp(p.z, 0.0, len)); }

#if SRS_MEETS(SRS_SHAPE_HOOK)
vec3 fromHook(vec3 p, float bend, float len) {
    float across = length(p.yz);
    vec3 nearest = vec3(0.0, p.y < 0.0 ? -bend : bend, 0.0); // beyond the half circle: its ends
    if (p.z <= 0.0)
        nearest = across > 1e-6 ? vec3(0.0, p.yz) * (bend / across) : vec3(0.0, 0.0, -bend);
    vec3 arc = p - nearest, shank = fromShank(p, -bend, len);
    return dot(shank, shank) < dot(arc, arc) ? shank : arc;
}
#endif

#if SRS_MEETS(SRS_SHAPE_BOX)
vec4 aroundBox(vec3 p, vec3 halfSize, float radius) {
    vec3 outward = abs(p) - halfSize;
    vec3 side = vec3(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0, p.z < 0.0 ? -1.0 : 1.0);
    vec3 beyond = max(outward, 0.0);
    float apart = length(beyond);
    if (apart > 1e-6)
        return vec4(side * beyond / apart, apart - radius);
    if (outward.x >= outward.y && outward.x >= outward.z) // the nearest face
        return vec4(side.x, 0.0, 0.0, outward.x - radius);
    return outward.y >= outward.z ? vec4(0.0, side.y, 0.0, outward.y - radius)
                                  : vec4(0.0, 0.0, side.z, outward.z - radius);
}
#endif

#if SRS_MEETS(SRS_SHAPE_MESH)
// The samples of all fields, m: sample (x, y, z) of one at (its column + x, y + samples along y * z). A 2D texture, read
// sample by sample: a texture unit's own interpolation has 8 bits, and gives no gradient.
uniform sampler2D t_fields;

vec4 sampleField(int c, vec3 own) {
    float spacing = b_collider[c].field.y;
    vec3 lowest = b_collider[c].middle.xyz;
    ivec3 dims = ivec3(b_collider[c].halfSize.xyz);
    vec3 within = clamp(own, lowest, lowest + spacing * vec3(dims - 1));
    vec3 at = (within - lowest) / spacing;
    ivec3 cell = clamp(ivec3(at), ivec3(0), dims - 2);
    vec3 share = clamp(at - vec3(cell), 0.0, 1.0);
    ivec2 first = ivec2(int(b_collider[c].field.x) + cell.x, cell.y + dims.y * cell.z);
    vec4 low, high; // at x and x + 1: (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1)
    low.x = texelFetch(t_fields, first, 0).x;
    low.y = texelFetch(t_fields, first + ivec2(0, 1), 0).x;
    low.z = texelFetch(t_fields, first + ivec2(0, dims.y), 0).x;
    low.w = texelFetch(t_fields, first + ivec2(0, dims.y + 1), 0).x;
    high.x = texelFetch(t_fields, first + ivec2(1, 0), 0).x;
    high.y = texelFetch(t_fields, first + ivec2(1, 1), 0).x;
    high.z = texelFetch(t_fields, first + ivec2(1, dims.y), 0).x;
    high.w = texelFetch(t_fields, first + ivec2(1, dims.y + 1), 0).x;
    vec4 along = mix(low, high, share.x), slopes = high - low;
    vec2 mixedY = mix(along.xz, along.yw, share.y), slopesX = mix(slopes.xz, slopes.yw, share.y);
    float value = mix(mixedY.x, mixedY.y, share.z) * b_collider[c].field.z;
    vec3 gradient = vec3(mix(slopesX.x, slopesX.y, share.z), mix(along.y - along.x, along.w - along.z, share.z),
                         mixedY.y - mixedY.x) * (b_collider[c].field.z / spacing);
    vec3 beyond = own - within; // sim/distance_field.h
    float away2 = dot(beyond, beyond);
    if (away2 > 0.0) {
        float near = max(value, 0.0);
        value = sqrt(away2 + near * near);
        gradient = beyond + near * gradient;
    }
    float len = length(gradient);
    return vec4(len > 1e-6 ? gradient / len : vec3(0.0, 1.0, 0.0), value);
}
#endif

vec4 sampleShape(int c, vec3 own) {
    float radius = b_collider[c].size.x;
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
        return vec4(0.0, 1.0, 0.0, own.y - radius);
#endif
#if SRS_MEETS(SRS_SHAPE_MESH)
    if (shape == SRS_SHAPE_MESH)
        return sampleField(c, own) - vec4(0.0, 0.0, 0.0, radius);
#endif
    return aroundCore(own, radius);
}
