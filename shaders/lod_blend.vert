#version 450 core
// A switch of level of detail or of binding, once a vertex: where the other mapping drew it against where this one does, in
// axes that turn with this one's tissue (MS05 3.3). Captured; surface.vert adds it to the vertex and lets it fade, so that
// the surface does not jump and what is left of the difference turns with the tissue.
#include "packed_normal.glsl"
#include "mapping.glsl"

layout(location = 5) in vec3 a_shownPosition; // lattice units of the other one
layout(location = 6) in vec3 a_shownNormal;

uniform float u_shownScale; // the other one's spacing over this one's
uniform vec3 u_shownShift;  // its lattice coordinate 0, in this one's

out vec3 v_offset; // in the axes
out vec3 v_normal;

void main() {
    Mapped mapped = mapVertex();
    v_offset = (u_shownScale * a_shownPosition + u_shownShift - mapped.position) * mapped.axes;
    v_normal = (a_shownNormal - mapped.normal) * mapped.axes;
    gl_Position = vec4(0.0);
}
