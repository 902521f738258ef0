#version 450 core
// A tool or body from its core and normals (render/tool_meshes.h). Lattice units.
layout(location = 0) in vec3 a_core;
layout(location = 1) in vec3 a_normal;

uniform mat4 u_clipFromLattice;
uniform vec3 u_at;      // of its reference point
uniform mat3 u_turn;
uniform float u_scale;  // lattice units over the unit of a_core
uniform float u_radius; // of the rounding

out vec3 v_position;
out vec3 v_normal;
out vec3 v_own; // as a_core

void main() {
    v_own = a_core;
    v_normal = u_turn * a_normal;
    v_position = u_at + (u_turn * (u_scale * a_core) + u_radius * v_normal);
    gl_Position = u_clipFromLattice * vec4(v_position, 1.0);
}
