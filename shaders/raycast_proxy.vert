#version 450 core
// The coarse deformation of the hybrid (CS07 section 6.3): moves the corners of the proxy's tetrahedra (render/ray_proxy.h).
#include "coarse_map.glsl"

uniform vec3 u_proxyLowest; // object space
uniform float u_proxyStep;
uniform ivec3 u_proxyCorners; // along each axis

out vec3 v_rest, v_moved; // object space

void main() {
    int row = gl_VertexID / u_proxyCorners.x;
    ivec3 at = ivec3(gl_VertexID % u_proxyCorners.x, row % u_proxyCorners.y, row / u_proxyCorners.y);
    v_rest = u_proxyLowest + u_proxyStep * vec3(at);
    v_moved = coarseForward(v_rest);
}
