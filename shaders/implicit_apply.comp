// The matrix of the implicit step times a vector of nodes, and their product. Twin of ImplicitSystem::apply.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_springs.glsl"
#include "implicit_symmetric.glsl"
#ifdef SRS_VOLUME
#include "implicit_cell_data.glsl"
#endif
uniform float u_drag;
uniform int u_vector; // SRS_VEC_...
uniform int u_iteration;

vec3 g_here, g_sum;

void addSpring(int i, int d) {
    int other = neighbourOf(i, d);
    if (other < 0)
        return;
    vec4 spring = springOf(i, d);
    vec3 apart = g_here - VECTOR(u_vector, other).xyz;
    g_sum += dot(spring.xyz, apart) * spring.xyz + spring.w * apart;
}

void main() {
    if (b_doneAt < u_iteration)
        return;
    int i = int(gl_GlobalInvocationID.x);
    float curvature = 0.0;
    if (i < u_nodes) {
        float share = VECTOR(SRS_VEC_V, i).w;
        g_sum = vec3(0.0);
        if (share > 0.0) {
            g_here = VECTOR(u_vector, i).xyz;
            g_sum = VECTOR(SRS_VEC_X, i).w * (1.0 / share + u_drag) * g_here;
            addSpring(i, 0);
            addSpring(i, 1);
            addSpring(i, 2);
            addSpring(i, 3);
            addSpring(i, 4);
            addSpring(i, 5);
            addSpring(i, 6);
            addSpring(i, 7);
            addSpring(i, 8);
            addSpring(i, 9);
            addSpring(i, 10);
            addSpring(i, 11);
            addSpring(i, 12);
            addSpring(i, 13);
            addSpring(i, 14);
            addSpring(i, 15);
            addSpring(i, 16);
            addSpring(i, 17);
#ifdef SRS_VOLUME
            for (int octant = 0; octant < 8; ++octant) {
                int cell = cellAround(0, i, octant);
                if (cell < 0)
                    continue;
                vec4 second = CELL(SRS_CELL_ROOT + 1, cell);
                g_sum += second.w * (mat3(CELL(SRS_CELL_ROOT, cell).xyz, second.xyz,
                                          CELL(SRS_CELL_ROOT + 2, cell).xyz) * cornerSign(7 - octant));
            }
#endif
#ifdef SRS_CONTACT
            g_sum += times(Symmetric(VECTOR(SRS_VEC_KA, i).xyz, VECTOR(SRS_VEC_KB, i).xyz), g_here);
#endif
            curvature = dot(g_here, g_sum);
        }
        VECTOR(SRS_VEC_Q, i) = vec4(g_sum, 0.0);
    }
    leaveSum(SRS_SUM_CURVATURE, vec4(curvature));
}
