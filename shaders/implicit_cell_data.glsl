// What the passes of the implicit step know of cells: constants, and arrays of one vec4 a cell.
layout(std430) buffer b_cells { vec4 b_cell[]; };              // SRS_CELL_...
layout(std430) readonly buffer b_cellShares { vec2 b_cellShare[]; }; // a f; material
layout(std430) readonly buffer b_connections { uint b_connection[]; }; // 18 bits a node, what cuts left
uniform int u_cells;

#define CELL(array, i) b_cell[(array) * u_cells + (i)]

float shareOf(int cell) { return b_cellShare[cell].x; }
uint materialOf(int cell) { return uint(b_cellShare[cell].y); }
uint connectionsOf(int node) { return b_connection[node]; }

const uint kInside[8] = uint[8](SRS_IN_CELL_0, SRS_IN_CELL_1, SRS_IN_CELL_2, SRS_IN_CELL_3, SRS_IN_CELL_4,
                                SRS_IN_CELL_5, SRS_IN_CELL_6, SRS_IN_CELL_7);

float freeCorners(bool free[8]) {
    float count = 0.0;
    for (int c = 0; c < 8; ++c)
        count += free[c] ? 1.0 : 0.0;
    return count;
}

/// Mean deformation gradient. Differences first: they are exact, and the rest state is exactly the identity.
mat3 gradientOf(vec3 p[8]) {
    return mat3(0.25 * ((p[1] - p[0]) + (p[3] - p[2]) + (p[5] - p[4]) + (p[7] - p[6])),
                0.25 * ((p[2] - p[0]) + (p[3] - p[1]) + (p[6] - p[4]) + (p[7] - p[5])),
                0.25 * ((p[4] - p[0]) + (p[5] - p[1]) + (p[6] - p[2]) + (p[7] - p[3])));
}
mat3 cofactors(mat3 f) { return mat3(cross(f[1], f[2]), cross(f[2], f[0]), cross(f[0], f[1])); }
float contract(mat3 a, mat3 b) { return dot(a[0], b[0]) + dot(a[1], b[1]) + dot(a[2], b[2]); }
float softening(mat3 cofactor) {
    float share = min(1.0, SRS_VOLUME_STIFFENING / max(contract(cofactor, cofactor), 1e-12));
    return share * share;
}

/// Of one cell: a f dW/dF / 4, and cof F / 4 times the root of the stiffness that is kept of it.
void volumeTerms(mat3 f, float bulk, float recovery, float factor, float tangent, out mat3 load, out mat3 root) {
    mat3 cofactor = cofactors(f);
    float change = dot(f[0], cofactor[0]) - 1.0, collapse = max(0.0, SRS_COLLAPSED - 1.0 - change);
    float size = contract(cofactor, cofactor), q = softening(cofactor), b = bulk * factor;
    load = (0.25 * q * (b * change - recovery * collapse)) * cofactor;
    if (size > SRS_VOLUME_STIFFENING) // dq/dF
        load -= (0.5 * q / size * (b * change * change + recovery * collapse * collapse)) *
                (contract(f, f) * f - f * (transpose(f) * f));
    root = (0.25 * sqrt(q * (bulk * tangent + (collapse > 0.0 ? recovery : 0.0)))) * cofactor;
}

/// Energy of the volumetric term over the fill. \param bulk b
float volumeEnergy(vec3 p[8], float bulk) {
    mat3 f = gradientOf(p), cofactor = cofactors(f);
    float change = dot(f[0], cofactor[0]) - 1.0;
    return 0.5 * bulk * softening(cofactor) * change * change;
}

#ifdef SRS_STIFFENING
#include "cell_stiffening.glsl"
#endif
