// The grasp pass of the compute solver.
#version 450 core
#include "grasp.glsl"
layout(local_size_x = 16, local_size_y = 8) in;

layout(rgba32ui) uniform writeonly restrict uimage2D i_newNodeInfo;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, imageSize(i_newNodeInfo))))
        imageStore(i_newNodeInfo, texel, infoAfterGrasp(texel));
}
