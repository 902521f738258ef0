// Trilinear embedding, to compare with: a vertex keeps its coordinates in a cell of the lattice.
layout(location = 0) in uint a_cell;
layout(location = 2) in vec3 a_offset; // from the cell's lowest corner, 0 .. 1

uniform usampler2D t_cells; // two texels a cell: node texels of its corners, as mapInCell has them

Mapped mapOwn() {
    ivec2 at = ivec2(2u * a_cell & (SRS_TABLE_WIDTH - 1u), 2u * a_cell / SRS_TABLE_WIDTH);
    return mapInCell(texelFetch(t_cells, at, 0), texelFetch(t_cells, at + ivec2(1, 0), 0), a_offset, unpackNormal(a_normal));
}
