// Where a vertex finds a corner of its cell. Beside a cut: where the vertex's side has it (render/side_nodes.h), so that a cell
// which the cut goes through is whole on each side.
#ifdef SURFACE_CUT
#include "surface_rest.glsl"
uniform sampler2D t_above, t_below;

vec4 followedNode(uint texel) {
    vec4 node = fetchNode(texel);
    float side = vertexSide();
    if (side == 0.0)
        return node;
    ivec2 at = ivec2(texel & 0xffffu, texel >> 16);
    vec4 carried = side > 0.0 ? texelFetch(t_above, at, 0) : texelFetch(t_below, at, 0);
    return carried.w == SRS_SIDE_NONE ? node : vec4(carried.xyz, node.w);
}
#else
vec4 followedNode(uint texel) {
    return fetchNode(texel);
}
#endif
