#version 450 core
// A tool's sphere from a unit sphere. Lattice units.
layout(location = 0) in vec3 a_position; // unit sphere

uniform mat4 u_clipFromLattice;
uniform vec4 u_sphere; // centre, radius

out vec3 v_position;
out vec3 v_normal;

void main() {
    v_normal = a_position;
    v_position = u_sphere.xyz + u_sphere.w * a_position;
    gl_Position = u_clipFromLattice * vec4(v_position, 1.0);
}
