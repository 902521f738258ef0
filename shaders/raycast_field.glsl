// The field of the body at rest (render/ray_field.h), object space. Negative inside (CS07: positive).
uniform vec3 u_fieldLowest;       // middle of its first voxel, object space
uniform float u_fieldStep;        // of a voxel, object space
#if RAYCAST_FIELD == SRS_FIELD_DISTANCE
uniform sampler3D t_field; // signed distance, voxels
#else
#include "raycast_depth.glsl"
#endif

/// Of the body at rest, object space: x its field in the grid, a signed distance but for depth maps; y the way to the grid.
vec2 fieldParts(vec3 rest) {
    vec3 at = (rest - u_fieldLowest) / u_fieldStep;
#if RAYCAST_FIELD == SRS_FIELD_DISTANCE
    vec3 size = vec3(textureSize(t_field, 0)), within = clamp(at, vec3(0.0), size - 1.0);
    float f = textureLod(t_field, (within + 0.5) / size, 0.0).x;
#else
    vec3 within = clamp(at, vec3(0.0), u_gridMost);
    float f = depthField(within);
#endif
    return u_fieldStep * vec2(f, distance(at, within));
}

/// Beyond the volume at least the way to it.
float field(vec3 rest) {
    vec2 parts = fieldParts(rest);
    return parts.x + parts.y;
}

/// Central differences over two voxels: over one, the bends of the trilinear field show as stripes.
vec3 fieldGradient(vec3 rest) {
#if RAYCAST_FIELD != SRS_FIELD_DISTANCE
    vec3 along = depthGradient(clamp((rest - u_fieldLowest) / u_fieldStep, vec3(0.0), u_gridMost));
    if (along != vec3(0.0))
        return along;
#endif
    vec3 by = vec3(u_fieldStep, 0.0, 0.0);
    return vec3(field(rest + by.xyy) - field(rest - by.xyy), field(rest + by.yxy) - field(rest - by.yxy),
                field(rest + by.yyx) - field(rest - by.yyx)) /
           (2.0 * u_fieldStep);
}
