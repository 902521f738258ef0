// The pass over the cells of the fragment solver.
#version 450 core
#include "cell_terms.glsl"

layout(location = 0) out vec4 o_x;
layout(location = 1) out vec4 o_y;
layout(location = 2) out vec4 o_z;

void main() {
    CellTerm term = cellTerm(ivec2(gl_FragCoord.xy));
    o_x = term.x;
    o_y = term.y;
    o_z = term.z;
}
