#version 450 core
// The axes that turn with a vertex (mapping.glsl), captured once a vertex: for what is measured of them.
#include "packed_normal.glsl"
#include "mapping.glsl"

out vec3 v_tangent;
out vec3 v_axis;
out vec3 v_bitangent;

void main() {
    Mapped mapped = mapVertex();
    v_tangent = mapped.axes[0];
    v_axis = mapped.axes[1];
    v_bitangent = mapped.axes[2];
    gl_Position = vec4(0.0);
}
