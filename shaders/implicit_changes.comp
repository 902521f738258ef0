// How Phi changes along Newton's step, for four shares of it, and what its gradient promises. Twin of
// ImplicitSystem::changes: no difference of two large numbers anywhere, but in cells that stiffen.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_cell_data.glsl"
#include "implicit_symmetric.glsl"
#include "implicit_weights.glsl"
uniform float u_drag;
uniform vec3 u_gravity;
uniform float u_damping;
uniform vec4 u_shares;
#ifdef SRS_VOLUME
uniform float u_bulks[SRS_MATERIALS];
uniform float u_recoveries[SRS_MATERIALS];
#endif

vec4 g_change;
vec3 g_here, g_step, g_before;

void addSpring(int i, int d, uint bits, float rest) {
    int other = neighbourOf(i, d);
    if (other < 0 || ((bits >> d) & 1u) == 0u)
        return;
    vec3 that = VECTOR(SRS_VEC_X, other).xyz;
    vec3 apart = g_here - (that + VECTOR(SRS_VEC_U, other).xyz), turn = g_step - VECTOR(SRS_VEC_S, other).xyz;
    float len = length(apart), damper = damperOf(i, d, u_damping), before = damper > 0.0 ? length(g_before - that) : 0.0;
#ifdef SRS_STIFFENING
    float weight = 0.0; // cells count theirs
#else
    float tangent, weight = weightOf(i, d, tangent);
#endif
    vec4 rise2 = u_shares * (2.0 * dot(apart, turn) + u_shares * dot(turn, turn));
    vec4 moved = sqrt(max(vec4(0.0), len * len + rise2));
    vec4 rise = rise2 / max(moved + len, vec4(1e-6));
    g_change += 0.5 * rise * (weight * (moved + len - 2.0 * rest) + damper * (moved + len - 2.0 * before));
}

#ifdef SRS_CELL_PASS
/// W at F + s G minus W at F (sim/implicit_system.cpp, volumeChange).
float volumeChange(mat3 f, mat3 g, float s, float bulk, float recovery) {
    mat3 before = cofactors(f), of = cofactors(g), after = cofactors(f + s * g);
    float volume = dot(f[0], before[0]);
    float rise = s * (contract(before, g) + s * (contract(of, f) + s * dot(g[0], of[0])));
    float q = softening(before), movedQ = softening(after);
    float collapse = max(0.0, SRS_COLLAPSED - volume), movedCollapse = max(0.0, SRS_COLLAPSED - (volume + rise));
    float part = 0.5 * (bulk * (volume - 1.0) * (volume - 1.0) + recovery * collapse * collapse);
    float partRise = 0.5 * (bulk * rise * (rise + 2.0 * (volume - 1.0)) +
                            recovery * (movedCollapse - collapse) * (movedCollapse + collapse));
    return movedQ * partRise + (movedQ - q) * part;
}

void addCell(int cell) {
    vec3 y[8], p[8];
    uint bits[8];
    bool whole = true;
    for (int c = 0; c < 8; ++c) {
        int node = cornerOf(0, cell, c);
        y[c] = VECTOR(SRS_VEC_X, node).xyz + VECTOR(SRS_VEC_U, node).xyz;
        p[c] = VECTOR(SRS_VEC_S, node).xyz;
        bits[c] = connectionsOf(node) & kInside[c];
        whole = whole && bits[c] == kInside[c];
    }
    uint material = materialOf(cell);
    float share = shareOf(cell), bulk = 0.0, recovery = 0.0;
#ifdef SRS_VOLUME
    bulk = whole ? u_bulks[material] : 0.0;
    recovery = whole ? u_recoveries[material] : 0.0;
#endif
#ifdef SRS_STIFFENING
    float before = stiffenedEnergy(material, springEnergy(material, bits, y) + volumeEnergy(y, bulk));
    for (int k = 0; k < 4; ++k) {
        vec3 moved[8];
        for (int c = 0; c < 8; ++c)
            moved[c] = y[c] + u_shares[k] * p[c];
        g_change[k] += share * (stiffenedEnergy(material, springEnergy(material, bits, moved) +
                                                              volumeEnergy(moved, bulk)) - before);
    }
    bulk = 0.0;
#endif
    if (bulk + recovery == 0.0)
        return;
    mat3 f = gradientOf(y), g = gradientOf(p);
    for (int k = 0; k < 4; ++k)
        g_change[k] += share * volumeChange(f, g, u_shares[k], bulk, recovery);
}
#endif

void main() {
    int i = int(gl_GlobalInvocationID.x);
    float promise = 0.0;
    g_change = vec4(0.0);
    if (i < u_nodes) {
        vec4 x = VECTOR(SRS_VEC_X, i), expected = VECTOR(SRS_VEC_V, i);
        vec3 u = VECTOR(SRS_VEC_U, i).xyz;
        g_before = x.xyz;
        g_here = x.xyz + u;
        g_step = VECTOR(SRS_VEC_S, i).xyz;
        uint bits = connectionsOf(i);
        addSpring(i, 0, bits, 1.0);
        addSpring(i, 2, bits, 1.0);
        addSpring(i, 4, bits, 1.0);
        addSpring(i, 6, bits, 1.41421356);
        addSpring(i, 8, bits, 1.41421356);
        addSpring(i, 10, bits, 1.41421356);
        addSpring(i, 12, bits, 1.41421356);
        addSpring(i, 14, bits, 1.41421356);
        addSpring(i, 16, bits, 1.41421356);
        if (expected.w > 0.0)
            g_change += x.w * u_shares *
                        (dot(g_step, (u - expected.xyz) / expected.w + u_drag * u - u_gravity) +
                         0.5 * u_shares * dot(g_step, g_step) * (1.0 / expected.w + u_drag));
#ifdef SRS_CONTACT
        if (expected.w > 0.0)
            g_change += u_shares * (0.5 * u_shares *
                                        dot(g_step, times(Symmetric(VECTOR(SRS_VEC_KA, i).xyz, VECTOR(SRS_VEC_KB, i).xyz),
                                                          g_step)) -
                                    dot(g_step, VECTOR(SRS_VEC_F, i).xyz));
#endif
        promise = dot(VECTOR(SRS_VEC_G, i).xyz, g_step);
    }
#ifdef SRS_CELL_PASS
    if (i < u_cells)
        addCell(i);
#endif
    leaveSum(SRS_SUM_CHANGES, g_change);
    leaveSum(SRS_SUM_PROMISE, vec4(promise));
}
