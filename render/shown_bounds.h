#pragma once
// Where a deformation texture may show a body (CS07 section 3.1: "the bounding box of the
// deformed object", there from the largest displacement). A ray is searched within: the closer it lies, the
// fewer samples.
//
// In a cell between texels q + D(q) is interpolated: a place in it comes from within the hull of its eight
// corners. Cells that come from elsewhere, or that the mask cuts away whole, show nothing. They are looked at
// in blocks first, so that a texture that moves from picture to picture costs little.

#include "render/deformation_texture.h"
#include "render/field_blocks.h"
#include "render/texture_mapping.h"

#include <vector>

namespace serosa::render {

class ShownBounds {
public:
    ShownBounds() = default;
    explicit ShownBounds(const DeformationTexture& texture);

    /// Of a body, in object space; of no size where nothing of it is shown. Outside of the texture's box
    /// things are shown where they rest. \param warp of the same texture
    Bounds of(const Warp& warp, const FieldBlocks& body) const;

private:
    /// Of cells; in texture space: where it is, and where D takes that from.
    struct Block {
        glm::ivec3 first{0}, end{0};
        glm::dvec3 middle{0}, half{0}, restMiddle{0}, restHalf{0};
        bool kept = false; // any of it
        Block() = default;
        Block(const DeformationTexture& texture, const glm::ivec3& first, const glm::ivec3& end);
    };
    std::vector<Block> blocks_; // that keep anything
};

} // namespace serosa::render
