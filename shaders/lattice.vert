#version 450 core
// The lattice over or instead of the surface (MS05 figures 1 and 2): a spring is a strip, a node a square of constant width in
// pixels, one instance each, drawn a little nearer to the eye so that the surface it lies on does not swallow it.
#include "node_texel.glsl"

layout(location = 0) in uvec2 a_ends; // node texels, y << 16 | x; bit 31 of the first: a diagonal. Nodes: both the same

uniform mat4 u_clipFromLattice;
uniform vec4 u_eye;      // lattice units, w = 1; or the direction to the eye, w = 0
uniform vec2 u_size;     // of the viewport, pixels
uniform float u_width;   // pixels
uniform float u_lift;    // towards the eye, lattice units
uniform float u_diagonal; // opacity of diagonals

out float v_opacity;
out vec2 v_across; // -1 .. 1

vec4 clipOf(uint texel) {
    vec3 q = fetchNode(texel & 0x7fffffffu).xyz;
    return u_clipFromLattice * vec4(q + u_lift * normalize(u_eye.xyz - q * u_eye.w), 1.0);
}

void main() {
    vec4 a = clipOf(a_ends.x), b = clipOf(a_ends.y);
    vec2 side = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
    vec2 along = (b.xy / b.w - a.xy / a.w) * u_size;
    vec2 direction = dot(along, along) > 1e-8 ? normalize(along) : vec2(1.0, 0.0);
    vec4 clip = side.x < 0.0 ? a : b;
    vec2 pixels = direction.yx * vec2(-1.0, 1.0) * side.y + (a_ends.x == a_ends.y ? direction * side.x : vec2(0.0));
    clip.xy += pixels * u_width / u_size * clip.w;
    gl_Position = min(a.w, b.w) > 0.0 ? clip : vec4(2.0, 2.0, 2.0, 1.0); // behind the eye: nowhere
    v_opacity = a_ends.x >> 31 != 0u ? u_diagonal : 1.0;
    v_across = a_ends.x == a_ends.y ? side : vec2(0.0);
}
