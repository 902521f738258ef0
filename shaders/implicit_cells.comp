// The cells of an implicit step at x + u': the load of the volumetric term and the root of its stiffness
// (sim/volume_law.h), by how much each cell has stiffened, and its point of quadrature for the coarser levels. Twin of
// the loops over cells in ImplicitSystem::gradient, linearizeCells and quadratureOf.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_symmetric.glsl"
#include "implicit_cell_data.glsl"

layout(std430) writeonly buffer b_quadratures { vec4 b_quadrature[]; };
#ifndef SRS_STIFFENING
uniform float u_springs[SRS_MATERIALS * 9]; // MaterialShares::spring
#endif
uniform float u_dampingTimes[SRS_MATERIALS];   // over dt
uniform float u_bulks[SRS_MATERIALS];          // (lambda - mu) h / k
uniform float u_recoveries[SRS_MATERIALS];     // of collapsed cells, k/h

vec3 g_x[8], g_y[8]; // corners before, and at x + u'
bool g_free[8];
Symmetric g_tensor[6];
float g_share, g_tangent, g_factor, g_damper;

void addSpring(float constant, uint bits, int d, int a, int b, float rest, vec3 square, vec3 mixed) {
    if (((bits >> d) & 1u) == 0u || !g_free[a] || !g_free[b])
        return;
    float share = g_share * constant * (d < 6 ? 0.25 : 0.5);
    vec3 apart = g_y[a] - g_y[b];
    float len = max(length(apart), 1e-6), along = share * (g_tangent + g_damper);
    float pull = share * (g_factor * (len - rest) + g_damper * (len - length(g_x[a] - g_x[b])));
    float across = clamp(pull / len, 0.0, along);
    Symmetric m = dyad(apart / len);
    m = scaled(along - across, m);
    m.d += across;
#define ADD(k, s) g_tensor[k].d += (s) * m.d, g_tensor[k].o += (s) * m.o
    ADD(0, square.x), ADD(1, square.y), ADD(2, square.z), ADD(3, mixed.x), ADD(4, mixed.y), ADD(5, mixed.z);
#undef ADD
}

void addSprings(uint material, uint bits[8]) {
    const float diagonal = 1.41421356;
    int first = int(material) * 9;
#define PAIR(p, d, a, b, rest, square, mixed) addSpring(u_springs[first + p], bits[a], d, a, b, rest, square, mixed);
#define EDGE(p, d, a, b, square) PAIR(p, d, a, b, 1.0, square, vec3(0.0))
    EDGE(0, 0, 0, 1, vec3(1, 0, 0)) EDGE(0, 0, 2, 3, vec3(1, 0, 0)) EDGE(0, 0, 4, 5, vec3(1, 0, 0))
    EDGE(0, 0, 6, 7, vec3(1, 0, 0)) EDGE(1, 2, 0, 2, vec3(0, 1, 0)) EDGE(1, 2, 1, 3, vec3(0, 1, 0))
    EDGE(1, 2, 4, 6, vec3(0, 1, 0)) EDGE(1, 2, 5, 7, vec3(0, 1, 0)) EDGE(2, 4, 0, 4, vec3(0, 0, 1))
    EDGE(2, 4, 1, 5, vec3(0, 0, 1)) EDGE(2, 4, 2, 6, vec3(0, 0, 1)) EDGE(2, 4, 3, 7, vec3(0, 0, 1))
#define FACE(p, d, a, b, square, mixed) PAIR(p, d, a, b, diagonal, square, mixed)
    FACE(3, 6, 0, 3, vec3(1, 1, 0), vec3(1, 0, 0)) FACE(3, 6, 4, 7, vec3(1, 1, 0), vec3(1, 0, 0))
    FACE(4, 8, 2, 1, vec3(1, 1, 0), vec3(-1, 0, 0)) FACE(4, 8, 6, 5, vec3(1, 1, 0), vec3(-1, 0, 0))
    FACE(5, 10, 0, 5, vec3(1, 0, 1), vec3(0, 0, 1)) FACE(5, 10, 2, 7, vec3(1, 0, 1), vec3(0, 0, 1))
    FACE(6, 12, 4, 1, vec3(1, 0, 1), vec3(0, 0, -1)) FACE(6, 12, 6, 3, vec3(1, 0, 1), vec3(0, 0, -1))
    FACE(7, 14, 0, 6, vec3(0, 1, 1), vec3(0, 1, 0)) FACE(7, 14, 1, 7, vec3(0, 1, 1), vec3(0, 1, 0))
    FACE(8, 16, 4, 2, vec3(0, 1, 1), vec3(0, -1, 0)) FACE(8, 16, 5, 3, vec3(0, 1, 1), vec3(0, -1, 0))
}

void main() {
    int cell = int(gl_GlobalInvocationID.x);
    if (cell >= u_cells)
        return;
    uint material = materialOf(cell);
    g_share = shareOf(cell);
    uint bits[8];
    bool whole = true, free = true;
    for (int c = 0; c < 8; ++c) {
        int node = cornerOf(0, cell, c);
        g_x[c] = VECTOR(SRS_VEC_X, node).xyz;
        g_y[c] = g_x[c] + VECTOR(SRS_VEC_U, node).xyz;
        g_free[c] = !isHeld(node);
        bits[c] = connectionsOf(node) & kInside[c];
        whole = whole && bits[c] == kInside[c];
        free = free && g_free[c];
    }
    g_factor = g_tangent = 1.0;
#ifdef SRS_STIFFENING
    if (hasCurve(material)) {
        float bulk = whole ? u_bulks[material] : 0.0;
        float strain = tensionStrain(material, springEnergy(material, bits, g_y) + volumeEnergy(g_y, bulk));
        g_factor = stiffeningAt(material, strain);
        g_tangent = max(g_factor, tangentAt(material, strain));
    }
#endif
    g_damper = u_dampingTimes[material];
    for (int k = 0; k < 6; ++k)
        g_tensor[k] = Symmetric(vec3(0.0), vec3(0.0));
    addSprings(material, bits);

    mat3 load = mat3(0.0), root = mat3(0.0);
#ifdef SRS_VOLUME
    float bulk = whole ? g_share * u_bulks[material] : 0.0;
    float recovery = whole ? g_share * u_recoveries[material] : 0.0;
    if (bulk + recovery > 0.0)
        volumeTerms(gradientOf(g_y), bulk, recovery, g_factor, g_tangent, load, root);
    CELL(SRS_CELL_LOAD, cell) = vec4(load[0], 0.0);
    CELL(SRS_CELL_LOAD + 1, cell) = vec4(load[1], 0.0);
    CELL(SRS_CELL_LOAD + 2, cell) = vec4(load[2], 0.0);
    CELL(SRS_CELL_ROOT, cell) = vec4(root[0], free ? 8.0 : freeCorners(g_free));
    CELL(SRS_CELL_ROOT + 1, cell) = vec4(root[1], 0.0);
    CELL(SRS_CELL_ROOT + 2, cell) = vec4(root[2], 0.0);
#endif
#ifdef SRS_STIFFENING
    CELL(SRS_CELL_FACTOR, cell) = vec4(g_factor, g_tangent, 0.0, 0.0);
#endif
    int first = levelInt(0, SRS_LEVEL_QUADRATURE) + SRS_QUADRATURE * cell;
    for (int k = 0; k < 6; ++k) {
        b_quadrature[first + 2 * k] = vec4(g_tensor[k].d, 0.0);
        b_quadrature[first + 2 * k + 1] = vec4(g_tensor[k].o, 0.0);
    }
    for (int k = 0; k < 3; ++k)
        b_quadrature[first + 12 + k] = vec4(free ? 4.0 * root[k] : vec3(0.0), 0.0);
}
