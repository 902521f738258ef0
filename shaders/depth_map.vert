#version 450 core
// A mesh seen along an axis of its grid, orthographic: a texel is a column of voxels (render/depth_maps.h).
layout(location = 0) in vec3 a_position; // voxels
layout(location = 1) in vec4 a_colour;
uniform int u_axis;
uniform float u_side; // texels

out float v_depth; // voxels
out vec4 v_colour;

void main() {
    vec3 at = vec3(a_position[(u_axis + 1) % 3], a_position[(u_axis + 2) % 3], a_position[u_axis]);
    v_depth = at.z;
    v_colour = a_colour;
    gl_Position = vec4(2.0 * (at + 0.5) / u_side - 1.0, 1.0);
}
