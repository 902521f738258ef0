#pragma once
// Where a body is: which blocks of a field's grid hold a place at which the field is not positive, and the
// box around all of those places. A ray looks for it nowhere else.
//
// In a cell between voxels the field is interpolated, and so nowhere less than in its corners: the bounds are
// no estimates.

#include "render/bounds.h"
#include "render/volume_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace serosa::render {

class FieldBlocks {
public:
    FieldBlocks() = default;
    /// All of a grid, where nothing more is known.
    explicit FieldBlocks(const VolumeGrid& grid);
    /// \param field one a voxel of the grid, x fastest; negative inside
    FieldBlocks(const VolumeGrid& grid, std::span<const float> field);

    /// Of the body; of no size where there is none.
    const Bounds& bounds() const { return bounds_; }
    /// Can there be any of it in a box?
    bool meets(const Bounds& box) const;

private:
    VolumeGrid grid_;
    Bounds bounds_;
    int cells_ = 1;                    // of a block, along an axis
    glm::ivec3 count_{1};              // of blocks
    std::vector<std::int32_t> before_; // blocks that hold any, of those before a block along all axes
};

} // namespace serosa::render
