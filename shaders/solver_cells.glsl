// What a node takes from its eight cells, as the pass of cell_terms.glsl wrote it: the force of the volumetric term
// (SRS_VOLUME), and by how much each cell has stiffened (SRS_STIFFENING). A cell lies at the texel of its lowest corner.
// Included by solver_kernel.glsl where SRS_CELL_PASS is defined.
uniform sampler2D t_cellX; // columns of fill dW/dF, fills 0 .. 255 (sim/volume_term.h)
uniform sampler2D t_cellY; // w: the factor of sim/stiffening.h
#ifdef SRS_VOLUME
uniform sampler2D t_cellZ;
#endif

#ifdef SRS_STIFFENING
Cells g_factors;
Cells timesFactors(Cells c) { return Cells(c.below * g_factors.below, c.above * g_factors.above); }
#endif

/// Adds the corner force -fill dW/dF sign of one cell in units of k h / 1020 (fill / 255 * 1020 / 4 = fill), and
/// returns its factor.
float addCell(uint fill, vec3 sign, ivec2 texel) {
    if (fill == 0u)
        return 1.0;
    vec4 y = texelFetch(t_cellY, texel, 0);
#ifdef SRS_VOLUME
    g_force -= sign.x * texelFetch(t_cellX, texel, 0).xyz + sign.y * y.xyz +
               sign.z * texelFetch(t_cellZ, texel, 0).xyz;
#endif
    return y.w;
}

void gatherCells(uvec4 info) {
    vec4 below, above;
    below.x = addCell(info.y & 255u, vec3(1.0, 1.0, 1.0), cellTexel(-1, -1, -1, ROW_yz));
    below.y = addCell((info.y >> 8) & 255u, vec3(-1.0, 1.0, 1.0), cellTexel(0, -1, -1, ROW_yz));
    below.z = addCell((info.y >> 16) & 255u, vec3(1.0, -1.0, 1.0), cellTexel(-1, 0, -1, ROW_z));
    below.w = addCell(info.y >> 24, vec3(-1.0, -1.0, 1.0), cellTexel(0, 0, -1, ROW_z));
    above.x = addCell(info.z & 255u, vec3(1.0, 1.0, -1.0), cellTexel(-1, -1, 0, ROW_y));
    above.y = addCell((info.z >> 8) & 255u, vec3(-1.0, 1.0, -1.0), cellTexel(0, -1, 0, ROW_y));
    above.z = addCell((info.z >> 16) & 255u, vec3(1.0, -1.0, -1.0), cellTexel(-1, 0, 0, ROW_SAME));
    above.w = addCell(info.z >> 24, vec3(-1.0, -1.0, -1.0), cellTexel(0, 0, 0, ROW_SAME));
#ifdef SRS_STIFFENING
    g_factors = Cells(below, above);
#endif
}
