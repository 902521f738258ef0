// One solver step as a compute pass: the node of solver_node.glsl, which the fragment pass has too. Stores what the
// fragment pass draws.
//
// Texels are addressed as SRS_GROUP_X x Y x Z invocations over the texture (rows layout, z = 1) or over the grid (x, y, z
// of a node; its texel is (x, y + ny z)). With SRS_TILES (grid only) a group first copies its nodes and a border one
// node wide to shared memory.
#version 450 core
#include "shared_constants.h"
layout(local_size_x = SRS_GROUP_X, local_size_y = SRS_GROUP_Y, local_size_z = SRS_GROUP_Z) in;
#include "solver_state.glsl"

layout(rgba32f) uniform writeonly restrict image2D i_newPositions;
layout(rgba32f) uniform writeonly restrict image2D i_newIncrements;
uniform ivec3 u_items; // texels of the texture, or nodes of the grid, along x, y, z

#ifndef SRS_TILES
vec3 loadPosition(ivec2 texel) { return fetchPosition(texel); }
vec3 loadIncrement(ivec2 texel) { return fetchIncrement(texel); }
#endif
#include "solver_node.glsl"

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
#ifdef SRS_TILES
    fillTile();
#endif
    if (any(greaterThanEqual(at, u_items)))
        return;
    ivec2 texel = at.xy;
#if SRS_LAYOUT == SRS_LAYOUT_GRID
    texel.y += SRS_GRID_NY * at.z;
#endif
    NodeStep result = stepNode(texel);
    imageStore(i_newPositions, texel, result.position);
    imageStore(i_newIncrements, texel, result.increment);
}
