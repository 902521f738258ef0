// The box that a deformation shader looks through, object space (lattice units).
#ifdef RAYCAST_LATTICE
#include "raycast_lattice.glsl"
vec3 boxLowest() {
    return b_lowest.xyz;
}
vec3 boxHighest() {
    return b_lowest.xyz + b_step.xyz * vec3(textureSize(t_lattice, 0) - 1);
}
#else
uniform vec3 u_boxLowest, u_boxHighest;
vec3 boxLowest() {
    return u_boxLowest;
}
vec3 boxHighest() {
    return u_boxHighest;
}
#endif
