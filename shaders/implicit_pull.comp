// The volumetric terms of the implicit step's matrix, before implicit_apply.comp: how strongly each cell resists the
// change of its volume that a vector of nodes is.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_cell_data.glsl"
uniform int u_vector; // SRS_VEC_...
uniform int u_iteration;

void main() {
    int cell = int(gl_GlobalInvocationID.x);
    if (cell >= u_cells || b_doneAt < u_iteration)
        return;
    vec3 p[8];
    for (int c = 0; c < 8; ++c)
        p[c] = VECTOR(u_vector, cornerOf(0, cell, c)).xyz;
    mat3 root = mat3(CELL(SRS_CELL_ROOT, cell).xyz, CELL(SRS_CELL_ROOT + 1, cell).xyz, CELL(SRS_CELL_ROOT + 2, cell).xyz);
    CELL(SRS_CELL_ROOT + 1, cell).w = 4.0 * contract(root, gradientOf(p));
}
