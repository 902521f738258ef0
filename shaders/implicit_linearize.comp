// The nodes of an implicit step at x + u': the gradient of Phi, and of the matrix the springs, the diagonal blocks with
// their inverses, and what is anchored (the mass, springs to held nodes) for the coarser levels. The Newton step begins
// at what held nodes must do, the residual at the gradient. Twin of ImplicitSystem::gradient, linearizeSprings and
// coarsen (level 0).
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_symmetric.glsl"
#include "implicit_cell_data.glsl"
#include "implicit_weights.glsl"

layout(std430) writeonly buffer b_springs { vec4 b_spring[]; }; // implicit_springs.glsl
layout(std430) writeonly buffer b_levels { vec4 b_level[]; };
uniform float u_drag;    // air drag dt
uniform vec3 u_gravity;  // dt^2 g / h
uniform float u_damping; // damping time / dt, where all materials have the same

vec3 g_sum, g_here, g_before;
Symmetric g_inside, g_anchored;

void addSpring(int i, int d, uint bits, float rest) {
    int other = neighbourOf(i, d);
    vec4 spring = vec4(0.0);
    if (other >= 0 && ((bits >> d) & 1u) != 0u) {
        vec4 that = VECTOR(SRS_VEC_X, other);
        vec3 apart = g_here - (that.xyz + VECTOR(SRS_VEC_U, other).xyz);
        float tangent, weight = weightOf(i, d, tangent), damper = damperOf(i, d, u_damping);
        float len = max(length(apart), 1e-6), along = tangent + damper;
        float pull = weight * (len - rest);
        if (damper > 0.0)
            pull += damper * (len - length(g_before - that.xyz));
        g_sum += (pull / len) * apart;
        float across = clamp(pull / len, 0.0, along);
        spring = vec4((sqrt(along - across) / len) * apart, across);
        Symmetric m = dyad(spring.xyz);
        m.d += across;
        if (isHeld(other))
            addTo(g_anchored, m);
        else
            addTo(g_inside, m);
    }
    b_spring[d * u_nodes + i] = spring;
}

void addSprings(int i, uint bits) {
    const float diagonal = 1.41421356;
    addSpring(i, 0, bits, 1.0);
    addSpring(i, 1, bits, 1.0);
    addSpring(i, 2, bits, 1.0);
    addSpring(i, 3, bits, 1.0);
    addSpring(i, 4, bits, 1.0);
    addSpring(i, 5, bits, 1.0);
    addSpring(i, 6, bits, diagonal);
    addSpring(i, 7, bits, diagonal);
    addSpring(i, 8, bits, diagonal);
    addSpring(i, 9, bits, diagonal);
    addSpring(i, 10, bits, diagonal);
    addSpring(i, 11, bits, diagonal);
    addSpring(i, 12, bits, diagonal);
    addSpring(i, 13, bits, diagonal);
    addSpring(i, 14, bits, diagonal);
    addSpring(i, 15, bits, diagonal);
    addSpring(i, 16, bits, diagonal);
    addSpring(i, 17, bits, diagonal);
}

#ifdef SRS_VOLUME
void addCells(int i) {
    for (int octant = 0; octant < 8; ++octant) {
        int cell = cellAround(0, i, octant);
        if (cell < 0)
            continue;
        vec3 sign = cornerSign(7 - octant);
        vec4 first = CELL(SRS_CELL_ROOT, cell);
        g_sum += mat3(CELL(SRS_CELL_LOAD, cell).xyz, CELL(SRS_CELL_LOAD + 1, cell).xyz,
                      CELL(SRS_CELL_LOAD + 2, cell).xyz) * sign;
        Symmetric m = dyad(mat3(first.xyz, CELL(SRS_CELL_ROOT + 1, cell).xyz, CELL(SRS_CELL_ROOT + 2, cell).xyz) * sign);
        addTo(g_inside, m);
        if (first.w < 8.0) // see ImplicitSystem::coarsen
            addTo(g_anchored, scaled(first.w, m));
    }
}
#endif

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u_nodes)
        return;
    vec4 x = VECTOR(SRS_VEC_X, i), expected = VECTOR(SRS_VEC_V, i);
    vec3 u = VECTOR(SRS_VEC_U, i).xyz;
    bool held = expected.w == 0.0;
    float inertia = x.w * ((held ? 1.0 : 1.0 / expected.w) + u_drag);
    g_before = x.xyz;
    g_here = x.xyz + u;
    g_sum = x.w * ((u - expected.xyz) / (held ? 1.0 : expected.w) + u_drag * u - u_gravity);
    g_anchored = Symmetric(vec3(inertia), vec3(0.0));
    g_inside = Symmetric(vec3(0.0), vec3(0.0));
    addSprings(i, connectionsOf(i));
#ifdef SRS_VOLUME
    addCells(i);
#endif
#ifdef SRS_CONTACT
    g_sum -= VECTOR(SRS_VEC_F, i).xyz;
    addTo(g_anchored, Symmetric(VECTOR(SRS_VEC_KA, i).xyz, VECTOR(SRS_VEC_KB, i).xyz));
#endif
    if (held)
        g_anchored = g_inside = Symmetric(vec3(0.0), vec3(0.0));
    addTo(g_inside, g_anchored);
    Symmetric inverse = inverseOf(g_inside);
    VECTOR(SRS_VEC_DA, i) = vec4(inverse.d, 0.0);
    VECTOR(SRS_VEC_DB, i) = vec4(inverse.o, 0.0);
    int anchored = levelInt(0, SRS_LEVEL_VECTORS);
    b_level[anchored + 4 * u_nodes + i] = vec4(g_anchored.d, 0.0);
    b_level[anchored + 5 * u_nodes + i] = vec4(g_anchored.o, 0.0);
    VECTOR(SRS_VEC_G, i) = vec4(g_sum, 0.0);
    VECTOR(SRS_VEC_S, i) = held ? vec4(VECTOR(SRS_VEC_T, i).xyz - u, 0.0) : vec4(0.0);
    VECTOR(SRS_VEC_R, i) = held ? vec4(0.0) : vec4(-g_sum, 0.0);
}
