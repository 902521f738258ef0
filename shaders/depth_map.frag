#version 450 core
// See shaders/depth_map.vert.
in float v_depth;
in vec4 v_colour;
layout(location = 0) out float o_depth;
layout(location = 1) out vec4 o_colour;

void main() {
    o_depth = v_depth;
    o_colour = v_colour;
}
