// The inverse of the last level's dense matrix, by one work group: assembled from the quadrature of the level below it,
// scaled to a unit diagonal, and swept (Gauss-Jordan without pivots, which a positive matrix does not need). Twin of
// ImplicitSystem::invertCoarsest.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_symmetric.glsl"

layout(std430) readonly buffer b_quadratures { vec4 b_quadrature[]; };
layout(std430) readonly buffer b_levels { vec4 b_level[]; };
layout(std430) writeonly buffer b_coarsest { float b_inverse[]; }; // row after row

#define SIZE (3 * SRS_IMPLICIT_COARSEST)
shared float s_matrix[SIZE * SIZE];
shared float s_column[SIZE];

/// The block of two nodes, from the cells that hold both.
mat3 blockOf(int level, int a, int b) {
    mat3 block = mat3(0.0);
    int nodes = levelInt(level, SRS_LEVEL_NODES), below = levelInt(level - 1, SRS_LEVEL_QUADRATURE);
    if (a == b) {
        int first = levelInt(level, SRS_LEVEL_VECTORS);
        vec3 d = b_level[first + 4 * nodes + a].xyz, o = b_level[first + 5 * nodes + a].xyz;
        block = mat3(d.x, o.x, o.z, o.x, d.y, o.y, o.z, o.y, d.z);
    }
    float volume = exp2(float(level - 3));
    for (int octant = 0; octant < 8; ++octant) {
        int cell = cellAround(level, a, octant);
        if (cell < 0)
            continue;
        for (int corner = 0; corner < 8; ++corner) {
            if (cornerOf(level, cell, corner) != b)
                continue;
            for (int inside = 0; inside < 8; ++inside) {
                int part = partOf(level, cell, inside);
                if (part < 0)
                    continue;
                vec3 ga = octantGradient(7 - octant, inside), gb = octantGradient(corner, inside);
                vec3 square = ga * gb, mixed = ga * gb.yzx + ga.yzx * gb;
                int at = below + SRS_QUADRATURE * part;
                vec3 d = square.x * b_quadrature[at].xyz + square.y * b_quadrature[at + 2].xyz +
                         square.z * b_quadrature[at + 4].xyz + mixed.x * b_quadrature[at + 6].xyz +
                         mixed.y * b_quadrature[at + 8].xyz + mixed.z * b_quadrature[at + 10].xyz;
                vec3 o = square.x * b_quadrature[at + 1].xyz + square.y * b_quadrature[at + 3].xyz +
                         square.z * b_quadrature[at + 5].xyz + mixed.x * b_quadrature[at + 7].xyz +
                         mixed.y * b_quadrature[at + 9].xyz + mixed.z * b_quadrature[at + 11].xyz;
                block += volume * mat3(d.x, o.x, o.z, o.x, d.y, o.y, o.z, o.y, d.z);
#ifdef SRS_VOLUME
                mat3 root = mat3(b_quadrature[at + 12].xyz, b_quadrature[at + 13].xyz, b_quadrature[at + 14].xyz);
                block += volume * outerProduct(root * ga, root * gb);
#endif
            }
        }
    }
    return block; // [column][row]: column of b, row of a
}

void main() {
    int local = int(gl_LocalInvocationID.x), level = u_levels - 1, nodes = levelInt(level, SRS_LEVEL_NODES);
    int size = 3 * nodes;
    for (int pair = local; pair < nodes * nodes; pair += SRS_IMPLICIT_GROUP) {
        int a = pair / nodes, b = pair % nodes;
        if (a > b)
            continue;
        mat3 block = blockOf(level, a, b);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                s_matrix[(3 * a + i) * size + 3 * b + j] = block[j][i];
                s_matrix[(3 * b + j) * size + 3 * a + i] = block[j][i];
            }
    }
    barrier();
    // Scaled; what no part of the lattice is near gets a diagonal of its own.
    for (int i = local; i < size; i += SRS_IMPLICIT_GROUP)
        s_column[i] = s_matrix[i * size + i] > 0.0 ? inversesqrt(s_matrix[i * size + i]) : 0.0;
    barrier();
    for (int at = local; at < size * size; at += SRS_IMPLICIT_GROUP) {
        int i = at / size, j = at % size;
        s_matrix[at] = i == j ? 1.0 + SRS_IMPLICIT_REGULAR : s_matrix[at] * s_column[i] * s_column[j];
        if (i == j)
            b_inverse[size * size + i] = s_column[i];
    }
    barrier();
    for (int k = 0; k < size; ++k) {
        float pivot = 1.0 / max(s_matrix[k * size + k], SRS_IMPLICIT_REGULAR);
        for (int i = local; i < size; i += SRS_IMPLICIT_GROUP)
            s_column[i] = s_matrix[i * size + k];
        barrier();
        for (int at = local; at < size * size; at += SRS_IMPLICIT_GROUP) {
            int i = at / size, j = at % size;
            float value = i == k && j == k ? -1.0
                          : i == k         ? s_column[j]
                          : j == k         ? s_column[i]
                                           : 0.0;
            s_matrix[at] = i == k || j == k ? value * pivot : s_matrix[at] - s_column[i] * s_column[j] * pivot;
        }
        barrier();
    }
    // Swept at every pivot: minus the inverse.
    for (int at = local; at < size * size; at += SRS_IMPLICIT_GROUP)
        b_inverse[at] = -s_matrix[at];
}
