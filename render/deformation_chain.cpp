// See render/deformation_chain.h.
#include "render/deformation_chain.h"

#include "render/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::render {

namespace {

constexpr int kMargin = 2; // texels around the boxes, in which nothing moves

/// Of a texel in object space, the finest axis that is sampled at all.
double finest(const Warp& warp) {
    const glm::dmat3 axes = warp.mapping.jacobian(glm::dvec3(0));
    const glm::dvec3 texel = warp.texture->texelSize();
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        if (warp.texture->size()[axis] > 1)
            least = std::min(least, texel[axis] * glm::length(axes[axis]));
    return std::isfinite(least) ? least : texel.x * glm::length(axes[0]);
}

} // namespace

Result<ChainedWarp> chain(const std::vector<Warp>& warps, TexelFormat format, std::size_t mostTexels) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    double step = low.x;
    for (const Warp& warp : warps) {
        const Bounds box = warp.mapping.boundsOf(warp.texture->half());
        low = glm::min(low, box.lowest);
        high = glm::max(high, box.highest);
        step = std::min(step, finest(warp));
    }
    const glm::dvec3 extent = high - low;
    step = std::max(step, std::cbrt(extent.x * extent.y * extent.z / double(mostTexels)));
    const glm::ivec3 size = glm::ivec3(glm::ceil(extent / step)) + 2 * kMargin;
    const glm::dvec3 half = 0.5 * step * glm::dvec3(size), middle = 0.5 * (low + high);
    std::vector<glm::dvec4> texels(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
    parallelFor(texels.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 at(double(i % std::size_t(size.x)),
                                double(i / std::size_t(size.x) % std::size_t(size.y)),
                                double(i / std::size_t(size.x) / std::size_t(size.y)));
            const glm::dvec3 shown = middle + (at + 0.5) * step - half;
            glm::dvec4 read(shown, 1);
            for (auto warp = warps.rbegin(); warp != warps.rend(); ++warp) {
                const Warp::Point point = warp->at(glm::dvec3(read));
                read = glm::dvec4(point.rest, std::min(read.w, point.mask));
            }
            texels[i] = read - glm::dvec4(shown, 0);
        }
    });
    SEROSA_ASSIGN(DeformationTexture texture, DeformationTexture::create(size, half, format, texels));
    ChainedWarp made{std::move(texture), {}};
    made.mapping.objectFromLocal[3] = glm::dvec4(middle, 1);
    return made;
}

} // namespace serosa::render
