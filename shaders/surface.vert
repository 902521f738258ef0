#version 450 core
// The detailed surface: undeformed (SURFACE_STATIC), through a mapping (mapping.glsl), or the lattice's own boundary with one
// vertex a node (SURFACE_NODES, MS05 3.2). Lattice units; axes are the world's.
#include "packed_normal.glsl"
#ifdef SURFACE_NODES
#include "node_texel.glsl"
layout(location = 0) in uint a_texel; // y << 16 | x
uniform vec4 u_colour;                // as a_colour
#else
#ifdef SURFACE_STATIC
layout(location = 2) in vec3 a_offset; // the position
layout(location = 3) in uint a_normal; // packed
#else
#include "mapping.glsl"
#endif
layout(location = 4) in vec4 a_colour; // square root of the linear colour; ambient light that arrives
#endif

#ifdef SURFACE_BLEND // after a switch of level of detail or of binding (lod_blend.vert)
layout(location = 5) in vec3 a_blendOffset; // in the axes: what is missing to where the vertex was drawn before
layout(location = 6) in vec3 a_blendNormal;
uniform float u_blendFrames; // since the switch
uniform float u_blendStep;   // lattice units that it may move the vertex a frame
#endif

#ifdef SURFACE_REST // render/surface_vertices.h: RestVertex
#include "surface_rest.glsl"
uniform vec3 u_restFrom, u_restExtent; // of the box, lattice units

out vec3 v_rest;       // lattice units, where the cut mask and the textures are read
flat out float v_side; // of a cut that the triangle follows: -1, 1; 0: both
out float v_away;      // spacings from the cut, by the nodes; the sign is the side
out mat3 v_turn;       // to now from rest

/// The tangent that render/surface_vertices.h gives a normal, too (Duff et al. 2017).
vec3 anyTangent(vec3 n) {
    float sign = n.z < 0.0 ? -1.0 : 1.0, a = -1.0 / (sign + n.z);
    return vec3(1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x);
}
#endif
#ifdef SURFACE_UV
layout(location = 9) in vec2 a_uv;
layout(location = 10) in vec4 a_tangent; // of the texture, at rest, lattice axes; w: sign of its bitangent
out vec2 v_uv;
out vec4 v_tangent;
#endif

uniform mat4 u_clipFromLattice;
uniform vec4 u_section; // plane, lattice units: drawn where it is positive, if GL_CLIP_DISTANCE0 is on

out vec3 v_position;      // lattice units
out vec3 v_normal;        // of the surface
out vec3 v_dynamicNormal; // of the nodes
out vec4 v_colour;        // linear; ambient light that arrives

void main() {
#if defined(SURFACE_STATIC)
    v_position = a_offset;
    v_normal = unpackNormal(a_normal);
    v_dynamicNormal = v_normal;
    v_colour = a_colour;
#elif defined(SURFACE_NODES)
    vec4 node = fetchNode(a_texel);
    v_position = node.xyz;
    v_normal = nodeNormal(node);
    v_dynamicNormal = v_normal;
    v_colour = u_colour;
#else
    Mapped mapped = mapVertex();
    v_position = mapped.position;
    v_normal = mapped.normal;
#ifdef SURFACE_BLEND
    float rate = u_blendStep / max(length(a_blendOffset), 1e-6);
    float left = max(1.0 - u_blendFrames * clamp(rate, 1.0 / SRS_BLEND_MOST_FRAMES, 1.0 / SRS_BLEND_FRAMES), 0.0);
    v_position += mapped.axes * (left * a_blendOffset);
    v_normal += mapped.axes * (left * a_blendNormal);
#endif
    v_dynamicNormal = mapped.dynamicNormal;
    v_colour = a_colour;
#endif
    v_colour.rgb *= v_colour.rgb;
#ifdef SURFACE_REST
    v_rest = u_restFrom + a_rest.xyz * u_restExtent;
    v_side = vertexSide();
    v_away = vertexAway();
    vec3 frame = unpackNormal(a_frame.y), restN = unpackNormal(a_frame.x), restT = anyTangent(restN);
#ifdef SURFACE_STATIC
    vec3 t = frame;
#else
    vec3 t = carryTangent(mapped, frame, restT);
#endif
    vec3 n = normalize(v_normal);
    t = normalize(t - n * dot(n, t));
    v_turn = mat3(t, n, cross(n, t)) * transpose(mat3(restT, restN, cross(restN, restT)));
#endif
#ifdef SURFACE_UV
    v_uv = a_uv;
    v_tangent = a_tangent;
#endif
    gl_ClipDistance[0] = dot(u_section, vec4(v_position, 1.0));
    gl_Position = u_clipFromLattice * vec4(v_position, 1.0);
}
