// The lattice and its levels as numbers (sim/implicit_levels.h); -1: none.
layout(std430) readonly buffer b_tables { int b_table[]; };
uniform int u_levels;
uniform int u_neighbours; // place in b_table: SRS_NEIGHBOURS times nodes
uniform int u_texels;     // place in b_table: x + (y << 16), one a node

int levelInt(int level, int what) { return b_table[level * SRS_LEVEL_INTS + what]; }
int neighbourOf(int node, int d) { return b_table[u_neighbours + d * u_nodes + node]; }
ivec2 texelOf(int node) {
    int place = b_table[u_texels + node];
    return ivec2(place & 0xffff, place >> 16);
}
/// In octant 0 .. 7 around a node.
int cellAround(int level, int node, int octant) {
    return b_table[levelInt(level, SRS_LEVEL_AROUND) + octant * levelInt(level, SRS_LEVEL_NODES) + node];
}
int cornerOf(int level, int cell, int corner) {
    return b_table[levelInt(level, SRS_LEVEL_CORNERS) + corner * levelInt(level, SRS_LEVEL_CELLS) + cell];
}
int coarserOf(int level, int node, int k) {
    return b_table[levelInt(level, SRS_LEVEL_COARSER) + k * levelInt(level, SRS_LEVEL_NODES) + node];
}
int finerOf(int level, int node, int place) {
    return b_table[levelInt(level, SRS_LEVEL_FINER) + place * levelInt(level, SRS_LEVEL_NODES) + node];
}
float finerWeight(int place) {
    ivec3 at = ivec3(place % 3, place / 3 % 3, place / 9);
    return (at.x == 1 ? 1.0 : 0.5) * (at.y == 1 ? 1.0 : 0.5) * (at.z == 1 ? 1.0 : 0.5);
}
int partOf(int level, int cell, int octant) {
    return b_table[levelInt(level, SRS_LEVEL_PARTS) + octant * levelInt(level, SRS_LEVEL_CELLS) + cell];
}
/// (+-1, +-1, +-1) of a cell's corner.
vec3 cornerSign(int corner) {
    return vec3((corner & 1) * 2 - 1, (corner & 2) - 1, (corner >> 1 & 2) - 1);
}
/// Gradient of a corner's trilinear function at the middle of an octant, in units of 1/spacing.
vec3 octantGradient(int corner, int octant) {
    int same = ~(corner ^ octant);
    vec3 near = vec3((same & 1) != 0 ? 0.75 : 0.25, (same & 2) != 0 ? 0.75 : 0.25, (same & 4) != 0 ? 0.75 : 0.25);
    return cornerSign(corner) * near.yzx * near.zxy;
}
