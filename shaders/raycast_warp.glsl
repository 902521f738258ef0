// Warping of the deformation shader (CS07 sections 3.2, eq. 2): p = M(q + D(q)), q = M^-1 p'. Twin of Warp in
// render/deformation_texture.cpp; its derivatives are in raycast_jacobian.glsl. Object space is the lattice's unit, texture space m.
// The mask is 1 where kept (CS07: A < 0).
#ifdef RAYCAST_LATTICE
#include "raycast_lattice.glsl"
#endif
#ifdef RAYCAST_WARP
uniform sampler3D t_displacement; // D, as it is stored; A
uniform float u_scale, u_offset;  // D = u_scale texel + u_offset
uniform vec3 u_half, u_perSize;   // of the box, texture space: half of its size; 1 over its size
uniform mat4 u_localFromObject, u_objectFromLocal;
uniform mat4 u_unitFromObject;    // of an affine mapping: to the box, 0 to 1
uniform mat4 u_wayFromTexel;      // and of a texel's D in object space
uniform float u_still;            // texel that stands for no displacement
#ifdef RAYCAST_WOUND
uniform float u_cylinder;         // radius that the box is wound around
#endif

vec3 toTexture(vec3 object) {
    vec3 local = (u_localFromObject * vec4(object, 1.0)).xyz;
#ifdef RAYCAST_WOUND
    local = vec3(length(local.xz) - u_cylinder, local.y, u_cylinder * atan(local.z, local.x));
#endif
    return local;
}

#ifdef RAYCAST_WOUND
vec3 toObject(vec3 q) {
    float phi = q.z / u_cylinder;
    vec3 local = vec3((q.x + u_cylinder) * cos(phi), q.y, (q.x + u_cylinder) * sin(phi));
    return (u_objectFromLocal * vec4(local, 1.0)).xyz;
}
#endif

vec4 readDisplacement(vec3 q) {
    vec4 texel = textureLod(t_displacement, q * u_perSize + 0.5, 0.0);
    return vec4(u_scale * texel.xyz + u_offset, texel.w);
}

bool inBox(vec3 q) {
    return all(lessThanEqual(abs(q), u_half));
}
#endif

struct Warped {
    vec3 rest;    // p
    float mask;   // A
    bool covered; // there can be tissue
    float cut;    // to the nearest blade's cut, object space
    bool inside;  // of the texture's box
    vec3 q;       // in texture space
    vec3 unit;    // the same in its box, 0 to 1
};

/// First where the lattice has taken a point from, then where the texture has: a cut or a peel of a moving organ.
Warped warp(vec3 shown) {
    bool tissue = true;
    float kept = 1.0, cut = 1e9; // by the blades; the map's own mask comes beside
#ifdef RAYCAST_LATTICE
    Moved moved = moveBack(shown);
    tissue = moved.covered;
    kept = moved.kept;
    cut = moved.cut;
    shown = moved.rest;
#endif
#ifdef RAYCAST_WARP
#ifdef RAYCAST_WOUND
    vec3 q = toTexture(shown), unit = q * u_perSize + 0.5;
    bool inside = inBox(q);
    vec4 d = inside ? readDisplacement(q) : vec4(0.0, 0.0, 0.0, 1.0);
    vec3 rest = inside ? toObject(q + d.xyz) : shown;
#else
    // M(q + D) as p' and a way: most of a search is here.
    vec3 unit = (u_unitFromObject * vec4(shown, 1.0)).xyz, q = (2.0 * unit - 1.0) * u_half;
#ifdef RAYCAST_WITHIN // all rays run in it
    bool inside = true;
#else
    bool inside = all(lessThanEqual(abs(unit - 0.5), vec3(0.5)));
#endif
    vec4 d = inside ? textureLod(t_displacement, unit, 0.0) : vec4(vec3(u_still), 1.0);
    vec3 rest = shown + (u_wayFromTexel * vec4(d.xyz, 1.0)).xyz;
#endif
#ifdef RAYCAST_MASKED
    kept = min(d.w, kept);
#endif
    return Warped(rest, kept, tissue, cut, inside, q, unit);
#else
    return Warped(shown, kept, tissue, cut, false, shown, shown);
#endif
}
