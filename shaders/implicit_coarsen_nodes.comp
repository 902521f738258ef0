// The nodes of one coarser level: what is anchored, handed up from the level below, and the inverse of the diagonal
// block. Twin of ImplicitSystem::coarsen.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_symmetric.glsl"

layout(std430) readonly buffer b_quadratures { vec4 b_quadrature[]; };
layout(std430) buffer b_levels { vec4 b_level[]; };
uniform int u_level;

void main() {
    int i = int(gl_GlobalInvocationID.x), nodes = levelInt(u_level, SRS_LEVEL_NODES);
    if (i >= nodes)
        return;
    int below = levelInt(u_level - 1, SRS_LEVEL_VECTORS), finer = levelInt(u_level - 1, SRS_LEVEL_NODES);
    Symmetric anchored = Symmetric(vec3(0.0), vec3(0.0));
    for (int place = 0; place < 27; ++place) {
        int node = finerOf(u_level, i, place);
        if (node >= 0)
            addTo(anchored, scaled(finerWeight(place), Symmetric(b_level[below + 4 * finer + node].xyz,
                                                                 b_level[below + 5 * finer + node].xyz)));
    }
    Symmetric block = anchored;
    int blocks = levelInt(u_level, SRS_LEVEL_BLOCKS);
    for (int octant = 0; octant < 8; ++octant) {
        int cell = cellAround(u_level, i, octant);
        if (cell < 0)
            continue;
        int at = blocks + 16 * cell + 2 * (7 - octant);
        addTo(block, Symmetric(b_quadrature[at].xyz, b_quadrature[at + 1].xyz));
    }
    Symmetric inverse = inverseOf(block);
    int first = levelInt(u_level, SRS_LEVEL_VECTORS);
    b_level[first + 2 * nodes + i] = vec4(inverse.d, 0.0);
    b_level[first + 3 * nodes + i] = vec4(inverse.o, 0.0);
    b_level[first + 4 * nodes + i] = vec4(anchored.d, 0.0);
    b_level[first + 5 * nodes + i] = vec4(anchored.o, 0.0);
}
