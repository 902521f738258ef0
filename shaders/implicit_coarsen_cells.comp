// The cells of one coarser level: averages of their octants' quadrature, and what each cell gives to the diagonal block
// of each of its corners. Twin of ImplicitSystem::coarsen.
#version 450 core
#include "implicit_common.glsl"
#include "implicit_table.glsl"
#include "implicit_symmetric.glsl"

layout(std430) buffer b_quadratures { vec4 b_quadrature[]; };
uniform int u_level;

void main() {
    int cell = int(gl_GlobalInvocationID.x), cells = levelInt(u_level, SRS_LEVEL_CELLS);
    if (cell >= cells)
        return;
    vec4 mean[SRS_QUADRATURE];
    for (int k = 0; k < SRS_QUADRATURE; ++k)
        mean[k] = vec4(0.0);
    float square = 0.0;
    Symmetric blocks[8];
    for (int c = 0; c < 8; ++c)
        blocks[c] = Symmetric(vec3(0.0), vec3(0.0));
    int below = levelInt(u_level - 1, SRS_LEVEL_QUADRATURE);
    for (int octant = 0; octant < 8; ++octant) {
        int part = partOf(u_level, cell, octant);
        if (part < 0)
            continue;
        vec4 of[SRS_QUADRATURE];
        for (int k = 0; k < SRS_QUADRATURE; ++k)
            of[k] = b_quadrature[below + SRS_QUADRATURE * part + k];
        for (int k = 0; k < 12; ++k)
            mean[k] += 0.125 * of[k];
        for (int k = 12; k < 15; ++k) {
            mean[k] += of[k];
            square += 0.125 * dot(of[k].xyz, of[k].xyz);
        }
        for (int c = 0; c < 8; ++c) {
            vec3 g = octantGradient(c, octant), square3 = g * g, mixed = 2.0 * g * g.yzx;
            addTo(blocks[c], Symmetric(square3.x * of[0].xyz + square3.y * of[2].xyz + square3.z * of[4].xyz +
                                           mixed.x * of[6].xyz + mixed.y * of[8].xyz + mixed.z * of[10].xyz,
                                       square3.x * of[1].xyz + square3.y * of[3].xyz + square3.z * of[5].xyz +
                                           mixed.x * of[7].xyz + mixed.y * of[9].xyz + mixed.z * of[11].xyz));
#ifdef SRS_VOLUME
            addTo(blocks[c], dyad(mat3(of[12].xyz, of[13].xyz, of[14].xyz) * g));
#endif
        }
    }
    float size = dot(mean[12].xyz, mean[12].xyz) + dot(mean[13].xyz, mean[13].xyz) + dot(mean[14].xyz, mean[14].xyz);
    float scale = square > 0.0 ? sqrt(square / max(size, 1e-6 * square)) : 0.0;
    int first = levelInt(u_level, SRS_LEVEL_QUADRATURE) + SRS_QUADRATURE * cell;
    for (int k = 0; k < SRS_QUADRATURE; ++k)
        b_quadrature[first + k] = k < 12 ? mean[k] : scale * mean[k];
    float volume = exp2(float(u_level - 3)); // of a part, over the spacing squared
    first = levelInt(u_level, SRS_LEVEL_BLOCKS) + 16 * cell;
    for (int c = 0; c < 8; ++c) {
        b_quadrature[first + 2 * c] = vec4(volume * blocks[c].d, 0.0);
        b_quadrature[first + 2 * c + 1] = vec4(volume * blocks[c].o, 0.0);
    }
}
