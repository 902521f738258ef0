#version 450 core
// Tools of brushed steel: what the studio shows in a slightly blurred mirror. Bodies are matte.
#include "lighting.glsl"

uniform vec4 u_matte; // rgb: linear colour; w: 1 matte, 0 steel

in vec3 v_position;
in vec3 v_normal;
out vec4 o_colour;

vec3 steel(vec3 n, vec3 v) {
    vec3 r = reflect(-v, n), tint = vec3(0.63, 0.64, 0.66);
    vec3 colour = studio(r, 0.5) * mix(tint, vec3(1.0), fresnel(0.0, dot(n, v)));
    colour *= 0.25 + 0.75 * smoothstep(-0.75, 0.35, r.y); // the table below is dark
    return colour + tint * (0.12 * max(dot(n, u_toKey), 0.0) * u_key);
}

vec3 matte(vec3 n, vec3 v, vec3 tint) {
    vec3 light = surround(n) + kKeyColour * (1.4 * u_key * max(dot(n, u_toKey), 0.0)) +
                 kBackColour * (0.25 * u_key * max(dot(n, u_toBack), 0.0));
    return tint * light + 0.04 * studio(reflect(-v, n), 1.0);
}

void main() {
    vec3 n = normalize(v_normal), v = toEye(v_position);
    o_colour = vec4(toneMap(u_matte.w > 0.5 ? matte(n, v, u_matte.rgb) : steel(n, v)), 1.0);
}
