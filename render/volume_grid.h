#pragma once
// A regular grid of values in object space: of a distance field, or of what stands for one.

#include <glm/glm.hpp>

namespace serosa::render {

/// Voxel (i, j, k) has its middle at lowest + (i, j, k) step.
struct VolumeGrid {
    glm::ivec3 size{0};
    glm::dvec3 lowest{0}; // m: middle of voxel (0, 0, 0)
    double step = 0;      // m

    /// m: middle of the last voxel
    glm::dvec3 highest() const { return lowest + step * glm::dvec3(size - 1); }

    /// Holds the box with `margin` voxels around. \param samples along its longest side, margins apart
    static VolumeGrid around(const glm::dvec3& lowest, const glm::dvec3& highest, int samples, int margin);
};

} // namespace serosa::render
