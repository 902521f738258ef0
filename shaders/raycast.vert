#version 450 core
// The box around what a deformation shader may show: its far faces, so that a camera inside of it sees, too.
uniform mat4 u_clipFromLattice;
#include "raycast_box.glsl"

out vec3 v_position;

void main() {
    // Six faces of two triangles; a face's corners by the bits of two axes.
    int face = gl_VertexID / 6, corner = int[](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
    int axis = face / 2;
    vec3 at;
    at[axis] = float(face % 2);
    bool turned = face % 2 == 0;
    at[(axis + (turned ? 2 : 1)) % 3] = float(corner & 1);
    at[(axis + (turned ? 1 : 2)) % 3] = float(corner >> 1);
    v_position = mix(boxLowest(), boxHighest(), at);
    gl_Position = u_clipFromLattice * vec4(v_position, 1.0);
}
