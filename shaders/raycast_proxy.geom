#version 450 core
// The faces of those of the proxy's tetrahedra in which a ray may meet something, as the vertex stage has moved their corners.
#include "raycast_search.glsl"
#include "raycast_clear.glsl"

layout(lines_adjacency) in;
layout(triangle_strip, max_vertices = 6) out;

in vec3 v_rest[], v_moved[];

uniform mat4 u_clipFromLattice;

flat out vec3 v_corner;     // shown, the first one
flat out mat3 v_shares;     // coordinates along the edges from it, of a way from it
flat out vec3 v_restCorner; // the same corner at rest
flat out mat3 v_restEdges;  // the edges from it

/// Nothing lies in it. Balls around its middle and those of its four halved ends cover it.
bool isEmpty() {
    vec3 middle = 0.25 * (v_rest[0] + v_rest[1] + v_rest[2] + v_rest[3]);
    float end = 0.0, edge = 0.0; // from the middle to the furthest corner, middle of an edge
    for (int i = 0; i < 4; ++i) {
        end = max(end, distance(v_rest[i], middle));
        for (int j = 0; j < i; ++j)
            edge = max(edge, distance(0.5 * (v_rest[i] + v_rest[j]), middle));
    }
    bool clear = isClear(middle, edge);
    for (int i = 0; i < 4 && clear; ++i)
        clear = isClear(0.5 * (v_rest[i] + middle), 0.5 * end);
    return clear;
}

void main() {
    mat3 edges = mat3(v_moved[1] - v_moved[0], v_moved[2] - v_moved[0], v_moved[3] - v_moved[0]);
    float volume = determinant(edges), size = length(edges[0]) * length(edges[1]) * length(edges[2]);
    if (abs(volume) < 1e-5 * size || isEmpty()) // flat ones hold no way of a ray
        return;
    // Turned inside out, its faces are seen all the same.
    int order[4] = int[](0, volume > 0.0 ? 2 : 1, volume > 0.0 ? 1 : 2, 3);
    for (int i = 0; i < 6; ++i) {
        v_corner = v_moved[0];
        v_shares = inverse(edges);
        v_restCorner = v_rest[0];
        v_restEdges = mat3(v_rest[1] - v_rest[0], v_rest[2] - v_rest[0], v_rest[3] - v_rest[0]);
        gl_Position = u_clipFromLattice * vec4(v_moved[order[i % 4]], 1.0);
        EmitVertex();
    }
}
