// Where a node's neighbours lie in the state textures (sim/texture_layout.h). The solver defines SRS_LAYOUT and
// SRS_GRID_NY (grid: rows of nodes a slice) or SRS_ROW_LOG2 (rows: log2 of the texture's width).
//
// beginAddresses(texel) once, then neighbourTexel(dx, dy, dz) with constants. cellTexel is the same in textures, where
// neighbours are read from somewhere else.
#include "shared_constants.h"

#if defined SRS_TILES
#include "solver_tile.glsl"
#elif SRS_LAYOUT == SRS_LAYOUT_GRID

ivec2 g_texel;
void beginAddresses(ivec2 texel) { g_texel = texel; }
#define neighbourTexel(dx, dy, dz, row) (g_texel + ivec2(dx, (dy) + SRS_GRID_NY * (dz)))
#define cellTexel(dx, dy, dz, row) neighbourTexel(dx, dy, dz, row)

#else

layout(rgba32ui) uniform readonly restrict uimage2D i_rowOffsetsA;
layout(rgba32ui) uniform readonly restrict uimage2D i_rowOffsetsB;
int g_linear;
ivec4 g_rowsA; // (dy, dz) = (+,0) (-,0) (0,+) (0,-)
ivec4 g_rowsB; // (+,+) (-,-) (+,-) (-,+)
void beginAddresses(ivec2 texel) {
    g_linear = (texel.y << SRS_ROW_LOG2) + texel.x;
    g_rowsA = ivec4(imageLoad(i_rowOffsetsA, texel));
    g_rowsB = ivec4(imageLoad(i_rowOffsetsB, texel));
}
ivec2 texelOfLinear(int i) { return ivec2(i & ((1 << SRS_ROW_LOG2) - 1), i >> SRS_ROW_LOG2); }
#define ROW_SAME 0
#define ROW_Y g_rowsA.x
#define ROW_y g_rowsA.y
#define ROW_Z g_rowsA.z
#define ROW_z g_rowsA.w
#define ROW_YZ g_rowsB.x
#define ROW_yz g_rowsB.y
#define ROW_Yz g_rowsB.z
#define ROW_yZ g_rowsB.w
#define neighbourTexel(dx, dy, dz, row) texelOfLinear(g_linear + (row) + (dx))
#define cellTexel(dx, dy, dz, row) neighbourTexel(dx, dy, dz, row)

#endif
