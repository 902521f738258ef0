#version 450 core
// A dark, neutral room: light falls off from a little above the middle. The last bit is dithered, so that no bands show.
uniform vec2 u_size; // pixels
out vec4 o_colour;

void main() {
    vec2 at = (gl_FragCoord.xy - vec2(0.5, 0.56) * u_size) / max(u_size.x, u_size.y);
    float fall = smoothstep(0.0, 0.78, length(at));
    vec3 colour = mix(vec3(0.034, 0.040, 0.045), vec3(0.004, 0.005, 0.006), fall);
    float noise = fract(sin(dot(floor(gl_FragCoord.xy), vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
    o_colour = vec4(colour * (1.0 + 0.035 * noise), 1.0);
}
