// The box of a lattice's displacement texture (render/lattice_warp.h), made on the GPU.
#include "raycast_constants.h"

layout(std430) restrict buffer b_box {
    uint b_bound[6]; // of the nodes, as ordered words: lowest x, y, z, highest
    uint b_sum;  // over the nodes: way in a step, SRS_WAY_UNITS a lattice unit
    float b_way; // in a frame, the nodes' mean, lattice units
    vec4 b_lowest; // middle of voxel (0, 0, 0), lattice units
    vec4 b_step;   // of a voxel, along each axis
    uint b_nodesIn[3 * SRS_WARP_BINS]; // of even parts of the bounds, along x, y, z
};

/// A float as a word of the same order, and back.
uint ordered(float value) {
    uint bits = floatBitsToUint(value);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float unordered(uint word) {
    return uintBitsToFloat((word & 0x80000000u) != 0u ? word & 0x7fffffffu : ~word);
}
