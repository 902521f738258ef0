// The pass over the cells of the compute solver.
#version 450 core
layout(local_size_x = 16, local_size_y = 8) in;
#include "cell_terms.glsl"

layout(rgba32f) uniform writeonly restrict image2D i_cellX;
layout(rgba32f) uniform writeonly restrict image2D i_cellY;
layout(rgba32f) uniform writeonly restrict image2D i_cellZ;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(i_cellX))))
        return;
    CellTerm term = cellTerm(texel);
    imageStore(i_cellX, texel, term.x);
    imageStore(i_cellY, texel, term.y);
    imageStore(i_cellZ, texel, term.z);
}
