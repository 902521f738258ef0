// The volumetric term's second part: a node gathers what the pass of volume_cells.frag wrote for its eight cells. A cell
// lies at the texel of its lowest corner. Included by solver_kernel.glsl where SRS_VOLUME is defined.
uniform sampler2D t_volumeX; // columns of fill p cof(F), fills 0 .. 255 (sim/volume_term.h)
uniform sampler2D t_volumeY;
uniform sampler2D t_volumeZ;

/// Adds the corner force -fill p cof(F) sign of one cell in units of k h / 1020: fill / 255 * 1020 / 4 = fill.
void addCell(uint fill, vec3 sign, ivec2 texel) {
    if (fill == 0u)
        return;
    g_force -= sign.x * texelFetch(t_volumeX, texel, 0).xyz + sign.y * texelFetch(t_volumeY, texel, 0).xyz +
               sign.z * texelFetch(t_volumeZ, texel, 0).xyz;
}

void addVolume(uvec4 info) {
    addCell(info.y & 255u, vec3(1.0, 1.0, 1.0), neighbourTexel(-1, -1, -1, ROW_yz));
    addCell((info.y >> 8) & 255u, vec3(-1.0, 1.0, 1.0), neighbourTexel(0, -1, -1, ROW_yz));
    addCell((info.y >> 16) & 255u, vec3(1.0, -1.0, 1.0), neighbourTexel(-1, 0, -1, ROW_z));
    addCell(info.y >> 24, vec3(-1.0, -1.0, 1.0), neighbourTexel(0, 0, -1, ROW_z));
    addCell(info.z & 255u, vec3(1.0, 1.0, -1.0), neighbourTexel(-1, -1, 0, ROW_y));
    addCell((info.z >> 8) & 255u, vec3(-1.0, 1.0, -1.0), neighbourTexel(0, -1, 0, ROW_y));
    addCell((info.z >> 16) & 255u, vec3(1.0, -1.0, -1.0), neighbourTexel(-1, 0, 0, ROW_SAME));
    addCell(info.z >> 24, vec3(-1.0, -1.0, -1.0), neighbourTexel(0, 0, 0, ROW_SAME));
}
