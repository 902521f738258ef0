#version 450 core
// Springs and nodes in one colour; nodes are round.
uniform vec4 u_colour; // linear, opacity

in float v_opacity;
in vec2 v_across;
out vec4 o_colour;

void main() {
    if (dot(v_across, v_across) > 1.0)
        discard;
    o_colour = vec4(u_colour.rgb, u_colour.a * v_opacity);
}
