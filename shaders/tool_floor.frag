#version 450 core
// A floor: a matte patch with thin lines that fades out towards its edges.
#include "lighting.glsl"

uniform float u_lines; // lines over half the patch

in vec3 v_position;
in vec3 v_normal;
in vec3 v_own; // -1..1 over the patch
out vec4 o_colour;

const vec3 kFloor = vec3(0.052, 0.060, 0.066);
const vec3 kLine = vec3(0.115, 0.130, 0.140);
const float kLineWidth = 1.3; // pixels

/// Share of the pixel that a line along one axis covers.
vec2 lines(vec2 at, vec2 pixel) {
    vec2 apart = abs(fract(at - 0.5) - 0.5) / pixel;
    return clamp(0.5 + 0.5 * kLineWidth - apart, 0.0, 1.0) * clamp(0.35 / pixel - 0.5, 0.0, 1.0);
}

void main() {
    vec3 n = normalize(v_normal), v = toEye(v_position);
    vec2 at = v_own.xz * u_lines, on = lines(at, max(fwidth(at), vec2(1e-6)));
    vec3 tint = mix(kFloor, kLine, max(on.x, on.y));
    vec3 light = surround(n) + kKeyColour * (1.4 * u_key * max(dot(n, u_toKey), 0.0));
    vec3 colour = tint * light + 0.02 * fresnel(0.04, dot(n, v)) * studio(reflect(-v, n), 1.0);
    float fade = 1.0 - smoothstep(0.25, 1.0, length(v_own.xz));
    o_colour = vec4(toneMap(colour), fade);
}
