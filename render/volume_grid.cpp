// See render/volume_grid.h.
#include "render/volume_grid.h"

#include <algorithm>
#include <cmath>

namespace serosa::render {

VolumeGrid VolumeGrid::around(const glm::dvec3& lowest, const glm::dvec3& highest, int samples, int margin) {
    VolumeGrid grid;
    const glm::dvec3 size = highest - lowest;
    grid.step = std::max({size.x, size.y, size.z}) / std::max(samples - 1, 1);
    for (int axis = 0; axis < 3; ++axis)
        grid.size[axis] = int(std::ceil(size[axis] / grid.step - 1e-9)) + 1 + 2 * margin;
    grid.lowest = 0.5 * (lowest + highest) - 0.5 * grid.step * glm::dvec3(grid.size - 1);
    return grid;
}

} // namespace serosa::render
