// See render/field_blocks.h.
#include "render/field_blocks.h"

#include "base/check.h"

#include <algorithm>
#include <limits>

namespace serosa::render {

namespace {

constexpr int kMostBlocks = 64; // along an axis

} // namespace

FieldBlocks::FieldBlocks(const VolumeGrid& grid) : grid_(grid), bounds_{grid.lowest, grid.highest()} {}

FieldBlocks::FieldBlocks(const VolumeGrid& grid, std::span<const float> field) : grid_(grid) {
    const glm::ivec3 voxels = grid.size, cells = glm::max(voxels - 1, 1);
    SEROSA_CHECK(field.size() == std::size_t(voxels.x) * std::size_t(voxels.y) * std::size_t(voxels.z),
                 "a field has a value a voxel");
    const int most = std::max({cells.x, cells.y, cells.z});
    cells_ = (most + kMostBlocks - 1) / kMostBlocks;
    count_ = (cells + cells_ - 1) / cells_;
    const glm::ivec3 sums = count_ + 1;
    const auto sumAt = [this, &sums](int x, int y, int z) -> std::int32_t& {
        return before_[std::size_t(x) +
                       std::size_t(sums.x) * (std::size_t(y) + std::size_t(sums.y) * std::size_t(z))];
    };
    before_.assign(std::size_t(sums.x) * std::size_t(sums.y) * std::size_t(sums.z), 0);
    // A voxel that is not positive belongs to every cell around it.
    glm::ivec3 low(std::numeric_limits<int>::max()), high(-1);
    std::size_t voxel = 0;
    for (int z = 0; z < voxels.z; ++z)
        for (int y = 0; y < voxels.y; ++y)
            for (int x = 0; x < voxels.x; ++x, ++voxel) {
                if (!(field[voxel] <= 0))
                    continue;
                const glm::ivec3 at(x, y, z), first = glm::max(at - 1, 0), last = glm::min(at, cells - 1);
                low = glm::min(low, first);
                high = glm::max(high, last + 1);
                const glm::ivec3 a = first / cells_, b = last / cells_;
                for (int k = a.z; k <= b.z; ++k)
                    for (int j = a.y; j <= b.y; ++j)
                        for (int i = a.x; i <= b.x; ++i)
                            sumAt(i + 1, j + 1, k + 1) = 1;
            }
    for (int z = 1; z < sums.z; ++z)
        for (int y = 1; y < sums.y; ++y)
            for (int x = 1; x < sums.x; ++x)
                sumAt(x, y, z) += sumAt(x - 1, y, z) + sumAt(x, y - 1, z) + sumAt(x, y, z - 1) -
                                  sumAt(x - 1, y - 1, z) - sumAt(x - 1, y, z - 1) - sumAt(x, y - 1, z - 1) +
                                  sumAt(x - 1, y - 1, z - 1);
    if (high.x < 0)
        bounds_ = {grid.lowest, grid.lowest};
    else
        bounds_ = {grid.lowest + grid.step * glm::dvec3(low), grid.lowest + grid.step * glm::dvec3(high)};
}

bool FieldBlocks::meets(const Bounds& box) const {
    if (glm::any(glm::greaterThan(box.lowest, bounds_.highest)) ||
        glm::any(glm::lessThan(box.highest, bounds_.lowest)))
        return false;
    if (before_.empty())
        return true;
    const double size = grid_.step * cells_;
    const glm::dvec3 most(count_ - 1);
    const glm::ivec3 a(glm::clamp(glm::floor((box.lowest - grid_.lowest) / size), glm::dvec3(0), most)),
        b = glm::ivec3(glm::clamp(glm::floor((box.highest - grid_.lowest) / size), glm::dvec3(0), most)) + 1;
    const auto sum = [this](int x, int y, int z) {
        return before_[std::size_t(x) + std::size_t(count_.x + 1) *
                                            (std::size_t(y) + std::size_t(count_.y + 1) * std::size_t(z))];
    };
    return sum(b.x, b.y, b.z) - sum(a.x, b.y, b.z) - sum(b.x, a.y, b.z) - sum(b.x, b.y, a.z) +
               sum(a.x, a.y, b.z) + sum(a.x, b.y, a.z) + sum(b.x, a.y, a.z) - sum(a.x, a.y, a.z) >
           0;
}

} // namespace serosa::render
