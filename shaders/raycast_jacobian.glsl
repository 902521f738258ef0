// Derivatives of the warp (CS07 section 3.3, eq. 5, 6): of the place at rest, and of the mask.
#include "raycast_warp.glsl"

#ifdef RAYCAST_WARP
/// d toObject / d q
mat3 mappingJacobian(vec3 q) {
    mat3 local = mat3(1.0);
#ifdef RAYCAST_WOUND
    float phi = q.z / u_cylinder, share = q.x / u_cylinder + 1.0;
    local[0] = vec3(cos(phi), 0.0, sin(phi));
    local[2] = vec3(-share * sin(phi), 0.0, share * cos(phi));
#endif
    return mat3(u_objectFromLocal) * local;
}

/// Central differences over a texel: columns of d D / d q, and of A.
void displacementGradient(vec3 q, out mat3 gradient, out vec3 mask) {
    vec3 texel = 2.0 * u_half / vec3(textureSize(t_displacement, 0));
    for (int axis = 0; axis < 3; ++axis) {
        vec3 by = vec3(0.0);
        by[axis] = 0.5 * texel[axis];
        vec4 slope = (readDisplacement(q + by) - readDisplacement(q - by)) / texel[axis];
        gradient[axis] = slope.xyz;
        mask[axis] = slope.w;
    }
}
#endif

/// dp / dp'
mat3 warpJacobian(vec3 shown) {
    mat3 first = mat3(1.0);
#ifdef RAYCAST_LATTICE
    Moved moved = moveBack(shown);
    first = latticeJacobian(shown, moved.side);
    shown = moved.rest;
#endif
#ifdef RAYCAST_WARP
    vec3 q = toTexture(shown);
    if (inBox(q)) {
        mat3 gradient;
        vec3 mask;
        displacementGradient(q, gradient, mask);
        return mappingJacobian(q + readDisplacement(q).xyz) * (mat3(1.0) + gradient) * inverse(mappingJacobian(q)) * first;
    }
#endif
    return first;
}

/// Of the mask in object space: of a map's own by M's inverse transpose, of the blades' through the lattice.
vec3 maskGradient(vec3 shown) {
    mat3 first = mat3(1.0);
    float kept = 1.0;
    vec3 blade = vec3(0.0);
#ifdef RAYCAST_LATTICE
    Moved moved = moveBack(shown);
    first = latticeJacobian(shown, moved.side);
    shown = moved.rest;
#ifdef RAYCAST_CUT
    kept = moved.kept;
    blade = bladeGradient(shown, moved.side);
#endif
#endif
#ifdef RAYCAST_WARP
    vec3 q = toTexture(shown);
    if (inBox(q) && readDisplacement(q).w < kept) { // this mask ends nearer
        mat3 gradient;
        vec3 mask;
        displacementGradient(q, gradient, mask);
        return transpose(first) * (transpose(inverse(mappingJacobian(q))) * mask);
    }
#endif
    return transpose(first) * blade;
}
