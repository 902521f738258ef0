#pragma once
// Several deformations as one texture (CS07 sections 4, 6.3: deformations add up, and complex ones are
// composed of simpler ones).

#include "render/deformation_texture.h"

#include <vector>

namespace serosa::render {

/// p = W1(W2(... Wn(p'))), sampled on a box around those of all, its axes those of object space: the first
/// acts next to the object at rest. A point is kept where each keeps it. As fine as the finest of them, as
/// far as `mostTexels` allow. Errors: as DeformationTexture::create. \param warps at least one
struct ChainedWarp {
    DeformationTexture texture;
    TextureMapping mapping;
};
Result<ChainedWarp> chain(const std::vector<Warp>& warps, TexelFormat format,
                          std::size_t mostTexels = 1 << 21);

} // namespace serosa::render
