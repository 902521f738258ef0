#version 450 core
// A thread or clip (render/thread_renderer.h): a rod with round ends between two material points, each a sum of weights
// times nodes of an organ. The model is a rod of length 1 along z; lattice units of the frame.
layout(location = 0) in vec3 a_core; // z: 0 at the first end, 1 at the second
layout(location = 1) in vec3 a_normal;

uniform sampler2D t_first; // positions of the first end's organ
uniform sampler2D t_second;
uniform vec4 u_first[8]; // of each of its nodes: texel, weight
uniform vec4 u_second[8];
uniform vec4 u_firstPlace; // shift and (w) scale from the organ's lattice units to the frame's
uniform vec4 u_secondPlace;
uniform mat4 u_clipFromLattice;
uniform float u_radius;

out vec3 v_position;
out vec3 v_normal;

void main() {
    vec3 a = vec3(0.0), b = vec3(0.0);
    for (int i = 0; i < 8; ++i) {
        a += u_first[i].z * texelFetch(t_first, ivec2(u_first[i].xy), 0).xyz;
        b += u_second[i].z * texelFetch(t_second, ivec2(u_second[i].xy), 0).xyz;
    }
    a = u_firstPlace.xyz + u_firstPlace.w * a;
    b = u_secondPlace.xyz + u_secondPlace.w * b;
    vec3 along = b - a;
    vec3 z = dot(along, along) > 1e-12 ? normalize(along) : vec3(0.0, 1.0, 0.0);
    vec3 x = normalize(cross(abs(z.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0), z));
    v_normal = mat3(x, cross(z, x), z) * a_normal;
    v_position = mix(a, b, a_core.z) + u_radius * v_normal;
    gl_Position = u_clipFromLattice * vec4(v_position, 1.0);
}
