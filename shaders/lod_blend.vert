#version 450 core
// A switch of level of detail, once a vertex: where the other level's mapping drew it against where this one does, in the
// moving basis of this one's triangle (MS05 3.3). Captured; surface.vert adds it to the vertex's own offset and lets it fade,
// so that the surface does not jump and what is left of the difference turns with the tissue.
#include "packed_normal.glsl"
#include "mapping.glsl"

layout(location = 0) in uvec3 a_texels; // as surface.vert
layout(location = 1) in vec2 a_weights;
layout(location = 2) in vec3 a_offset;
layout(location = 3) in uint a_normal;
layout(location = 5) in vec3 a_shownPosition; // lattice units of the other level
layout(location = 6) in vec3 a_shownNormal;

uniform float u_shownScale; // the other level's spacing over this one's
uniform vec3 u_shownShift;  // its lattice coordinate 0, in this one's

out vec3 v_offset; // in the basis
out vec3 v_normal;

void main() {
    Mapped mapped = mapVertex(a_texels, a_weights, a_offset, (a_normal & 0x40000000u) != 0u);
    vec3 away = u_shownScale * a_shownPosition + u_shownShift - mapped.position;
    mat3 fromBasis = mat3(mapped.t, mapped.n, mapped.b);
    v_offset = away * fromBasis;
    v_normal = a_shownNormal * fromBasis - unpackNormal(a_normal);
    gl_Position = vec4(0.0);
}
