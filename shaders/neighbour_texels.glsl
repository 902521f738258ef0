// The texels of a node's 18 neighbours in the order of shared_constants.h, for passes that loop over them. (The solver's
// kernel is unrolled instead.) beginAddresses(texel) comes first.
#include "lattice_address.glsl"

void listNeighbours(out ivec2 texels[SRS_NEIGHBOURS]) {
    texels[0] = neighbourTexel(1, 0, 0, ROW_SAME);
    texels[1] = neighbourTexel(-1, 0, 0, ROW_SAME);
    texels[2] = neighbourTexel(0, 1, 0, ROW_Y);
    texels[3] = neighbourTexel(0, -1, 0, ROW_y);
    texels[4] = neighbourTexel(0, 0, 1, ROW_Z);
    texels[5] = neighbourTexel(0, 0, -1, ROW_z);
    texels[6] = neighbourTexel(1, 1, 0, ROW_Y);
    texels[7] = neighbourTexel(-1, -1, 0, ROW_y);
    texels[8] = neighbourTexel(1, -1, 0, ROW_y);
    texels[9] = neighbourTexel(-1, 1, 0, ROW_Y);
    texels[10] = neighbourTexel(1, 0, 1, ROW_Z);
    texels[11] = neighbourTexel(-1, 0, -1, ROW_z);
    texels[12] = neighbourTexel(1, 0, -1, ROW_z);
    texels[13] = neighbourTexel(-1, 0, 1, ROW_Z);
    texels[14] = neighbourTexel(0, 1, 1, ROW_YZ);
    texels[15] = neighbourTexel(0, -1, -1, ROW_yz);
    texels[16] = neighbourTexel(0, 1, -1, ROW_Yz);
    texels[17] = neighbourTexel(0, -1, 1, ROW_yZ);
}
