// See render/shown_bounds.h.
#include "render/shown_bounds.h"

#include "sim/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::render {

namespace {

constexpr int kMostBlocks = 32; // along an axis
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A box of object space around what lies within `half` of a place of texture space.
Bounds around(const TextureMapping& mapping, const glm::dvec3& middle, const glm::dvec3& half) {
    glm::dvec3 local = half;
    if (mapping.cylinderRadius > 0) {
        // A wound one: no further off than out or in and then round.
        const double r = middle.x + mapping.cylinderRadius;
        local.x = local.z = half.x + (std::abs(r) + half.x) * half.z / mapping.cylinderRadius;
    }
    const glm::dmat3 map(mapping.objectFromLocal);
    const glm::dvec3 by =
                         glm::abs(map[0]) * local.x + glm::abs(map[1]) * local.y + glm::abs(map[2]) * local.z,
                     at = mapping.toObject(middle);
    return {at - by, at + by};
}

} // namespace

ShownBounds::Block::Block(const DeformationTexture& texture, const glm::ivec3& firstCell,
                          const glm::ivec3& endCell)
    : first(firstCell), end(endCell) {
    // Cell c lies between texels c - 1 and c, of which the outermost reach to the box's faces.
    const auto face = [&texture](const glm::ivec3& cell) {
        return glm::clamp((glm::dvec3(cell) - 0.5) * texture.texelSize() - texture.half(), -texture.half(),
                          texture.half());
    };
    glm::dvec3 least(kInfinity), most(-kInfinity);
    for (int z = first.z; z <= end.z; ++z)
        for (int y = first.y; y <= end.y; ++y)
            for (int x = first.x; x <= end.x; ++x) {
                const glm::dvec4 texel = texture.texel(x - 1, y - 1, z - 1);
                const glm::dvec3 at = face({x, y, z}) + glm::dvec3(texel);
                least = glm::min(least, at);
                most = glm::max(most, at);
                kept = kept || texel.w >= 0.5;
            }
    middle = 0.5 * (face(first) + face(end));
    half = 0.5 * (face(end) - face(first));
    restMiddle = 0.5 * (least + most);
    restHalf = 0.5 * (most - least);
}

ShownBounds::ShownBounds(const DeformationTexture& texture) {
    const glm::ivec3 cells = texture.size() + 1, by = (cells + kMostBlocks - 1) / kMostBlocks;
    for (glm::ivec3 first(0); first.z < cells.z; first.z += by.z)
        for (first.y = 0; first.y < cells.y; first.y += by.y)
            for (first.x = 0; first.x < cells.x; first.x += by.x) {
                const Block block(texture, first, glm::min(first + by, cells));
                if (block.kept)
                    blocks_.push_back(block);
            }
}

Bounds ShownBounds::of(const Warp& warp, const FieldBlocks& body) const {
    const TextureMapping& mapping = warp.mapping;
    const Bounds& rest = body.bounds();
    Bounds shown{glm::dvec3(kInfinity), glm::dvec3(-kInfinity)};
    const auto add = [&shown](const Bounds& box) {
        shown.lowest = glm::min(shown.lowest, box.lowest);
        shown.highest = glm::max(shown.highest, box.highest);
    };
    /// Does it show anything beyond what is known?
    const auto adds = [&](const Block& block) {
        const Bounds box = around(mapping, block.middle, block.half);
        return (glm::any(glm::lessThan(box.lowest, shown.lowest)) ||
                glm::any(glm::greaterThan(box.highest, shown.highest))) &&
               body.meets(around(mapping, block.restMiddle, block.restHalf));
    };
    bool outside = mapping.cylinderRadius > 0; // a box that is wound around may leave its axis out
    for (int corner = 0; corner < 8 && !outside; ++corner) {
        const glm::dvec3 at = glm::mix(rest.lowest, rest.highest, glm::dvec3(sim::cornerOffset(corner)));
        outside = !glm::all(glm::lessThanEqual(glm::abs(mapping.toTexture(at)), warp.texture->half()));
    }
    if (outside)
        add(rest);
    for (const Block& block : blocks_) {
        if (!adds(block))
            continue;
        for (glm::ivec3 cell = block.first; cell.z < block.end.z; ++cell.z)
            for (cell.y = block.first.y; cell.y < block.end.y; ++cell.y)
                for (cell.x = block.first.x; cell.x < block.end.x; ++cell.x) {
                    const Block one(*warp.texture, cell, cell + 1);
                    if (one.kept && adds(one))
                        add(around(mapping, one.middle, one.half));
                }
    }
    if (shown.lowest.x > shown.highest.x)
        return {rest.lowest, rest.lowest};
    return shown;
}

} // namespace serosa::render
