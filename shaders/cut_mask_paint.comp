#version 450 core
// Paints a stroke into the mask in rest space (render/cut_mask.h): each voxel of a cell is carried to where it lies now, by its
// corners, and asked for its distance to what the stroke swept. A voxel keeps the nearest of all strokes: the least word
// wins, whatever the order.
#include "cut_mask_cells.glsl"
#include "cut_mask_stroke.glsl"

layout(local_size_x = SRS_MASK_GROUP) in;

layout(std430) readonly restrict buffer b_list {
    uint groups[4];
    uint listed[];
};
layout(std430) readonly restrict buffer b_sides { float sides[]; }; // of the nodes, before this stroke
layout(r32ui) uniform coherent uimage3D i_mask;

uniform int u_voxels;   // a cell, along each axis
uniform vec3 u_origin;  // lattice coordinate of the grid's lowest corner

shared vec3 s_moved[8]; // displacements of the corners
shared float s_side[8];
shared bool s_parted; // an earlier cut goes through the cell

/// Where the place `at` (0..1 in the cell) lies now, by the corners on one side of an earlier cut (0: by all).
vec3 displacement(vec3 at, float side) {
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int c = 0; c < 8; ++c) {
        vec3 toward = vec3(c & 1, c >> 1 & 1, c >> 2);
        vec3 w = mix(1.0 - at, at, toward);
        float weight = side * s_side[c] < 0.0 ? 0.0 : w.x * w.y * w.z;
        sum += weight * s_moved[c];
        weights += weight;
    }
    return abs(weights) > 1e-6 ? sum / weights : s_moved[0];
}

uint word(vec2 d) {
    float mask = 0.5 + 0.5 * float(u_voxels) * (d.x - SRS_MASK_WIDTH / float(u_voxels));
    float reach = 1.0 / SRS_MASK_REACH;
    bool burnt = u_kind == SRS_STROKE_CAUTERIZE;
    uint side = burnt ? 0xffffu : uint(round(65535.0 * clamp(0.5 + 0.5 * reach * d.y, 0.0, 1.0)));
    vec4 rest = vec4(0.0, 0.0, burnt ? 1.0 : min(reach * d.x, SRS_MASK_PAINTED), mask);
    return packUnorm4x8(rest) | (side >> 8 & 0xffu) << 8 | side & 0xffu;
}

void paint(MaskCell cell, ivec3 lowest) {
    int side = u_voxels + 2; // one voxel around it, where the organ ends
    for (int i = int(gl_LocalInvocationID.x); i < side * side * side; i += SRS_MASK_GROUP) {
        ivec3 local = ivec3(i % side, i / side % side, i / (side * side)) - 1;
        ivec3 beyond = ivec3(greaterThanEqual(local, ivec3(u_voxels))) - ivec3(lessThan(local, ivec3(0))) + 1;
        bool own = beyond == ivec3(1);
        if (!own && (cell.open >> (beyond.x + 3 * beyond.y + 9 * beyond.z) & 1u) == 0u)
            continue;
        vec3 at = (vec3(local) + 0.5) / float(u_voxels);
        ivec3 voxel = (lowest + 1) * u_voxels + local; // an empty cell lies around the grid
        float known = 0.0;
        if (own && s_parted) {
            vec4 before = unpackUnorm4x8(imageLoad(i_mask, voxel).x);
            known = before.z < SRS_MASK_PAINTED - 0.5 / 255.0 ? before.y - 0.5 : 0.0; // within reach
        }
        vec2 d = strokeDistance(u_origin + vec3(lowest) + at + displacement(at, known));
        if (d.x < SRS_MASK_SIDES)
            imageAtomicMin(i_mask, voxel, word(d));
    }
}

void main() {
    for (uint i = gl_WorkGroupID.x; i < groups[3]; i += gl_NumWorkGroups.x) {
        MaskCell cell = cells[listed[i]];
        ivec3 lowest = cellGrid(cell.grid);
        uint c = gl_LocalInvocationID.x;
        if (c < 8u) {
            vec3 rest = u_origin + vec3(lowest) + vec3(c & 1u, c >> 1 & 1u, c >> 2);
            s_moved[c] = nodePosition(cell.texels[c]) - rest;
            s_side[c] = sides[cell.nodes[c]];
        }
        barrier();
        if (c == 0u) {
            bool above = false, below = false;
            for (int k = 0; k < 8; ++k) {
                above = above || (s_side[k] >= 0.0 && s_side[k] < SRS_MASK_FAR);
                below = below || s_side[k] < 0.0;
            }
            s_parted = above && below;
        }
        barrier();
        paint(cell, lowest);
        barrier();
    }
}
