#version 450 core
// Brushed steel: what the studio shows in a slightly blurred mirror.
#include "lighting.glsl"

in vec3 v_position;
in vec3 v_normal;
out vec4 o_colour;

void main() {
    vec3 n = normalize(v_normal), v = toEye(v_position), r = reflect(-v, n);
    vec3 steel = vec3(0.63, 0.64, 0.66);
    vec3 colour = studio(r, 0.5) * mix(steel, vec3(1.0), fresnel(0.0, dot(n, v)));
    colour *= 0.25 + 0.75 * smoothstep(-0.75, 0.35, r.y); // the table below is dark
    colour += steel * (0.12 * max(dot(n, u_toKey), 0.0) * u_key);
    o_colour = vec4(toneMap(colour), 1.0);
}
