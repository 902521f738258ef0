// Bounds of what a deformation texture shows (render/shown_bounds.h) and blocks of a field
// (render/field_blocks.h): nothing lies outside of them, and they are no wider than a block where it is known
// how wide it is.
#include "render/shown_bounds.h"
#include "tests/render/ball_maps.h"

#include <gtest/gtest.h>

#include <random>

namespace serosa::render {

namespace {

constexpr double kRadius = 0.04, kVoxel = 0.0025;
constexpr glm::dvec3 kBall{kRadius};

/// Of a body that holds what is nearer to the middle than kRadius, by some measure of length.
template <typename Length>
FieldBlocks bodyOf(const Length& length) {
    const VolumeGrid grid = VolumeGrid::around(-kBall, kBall, 33, 3);
    std::vector<float> field;
    for (int z = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x)
                field.push_back(float(length(grid.lowest + grid.step * glm::dvec3(x, y, z)) - kRadius));
    EXPECT_NEAR(grid.step, kVoxel, 1e-12);
    return FieldBlocks(grid, field);
}

double round(const glm::dvec3& p) {
    return glm::length(p);
}

double boxy(const glm::dvec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

DeformationTexture textureOf(MapKind kind, const glm::ivec3& size, TexelFormat format = TexelFormat::single) {
    Result<DeformationTexture> made = DeformationTexture::bake(ballMap(kind), size, format);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
}

TextureMapping turned() {
    TextureMapping mapping;
    mapping.objectFromLocal[0] = {0.8, 0.9, 0, 0};
    mapping.objectFromLocal[1] = {-0.6, 0.8, 0.2, 0};
    mapping.objectFromLocal[2] = {0, -0.1, 1.1, 0};
    mapping.objectFromLocal[3] = {0.01, -0.005, 0.008, 1};
    return mapping;
}

TextureMapping wound() {
    TextureMapping mapping = turned();
    mapping.cylinderRadius = 0.03;
    return mapping;
}

/// Of many places tried, those that a warp shows a ball at, and that lie outside of its bounds.
int shownOutside(const Warp& warp, const Bounds& bounds, int& shown) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-0.12, 0.12);
    int outside = 0;
    for (int i = 0; i < 400000; ++i) {
        const glm::dvec3 at(place(random), place(random), place(random));
        const Warp::Point point = warp.at(at);
        // The field between voxels is above the true distance by at most h^2 / 8 of its Laplacian, 0.04 mm
        // here.
        if (point.mask < 0.5 || glm::length(point.rest) > kRadius - 4e-5)
            continue;
        ++shown;
        outside += glm::any(glm::lessThan(at, bounds.lowest - 1e-9)) ||
                   glm::any(glm::greaterThan(at, bounds.highest + 1e-9));
    }
    return outside;
}

} // namespace

TEST(ShownBounds, NothingIsShownOutsideOfThem) {
    const FieldBlocks body = bodyOf(round);
    for (const MapKind kind : {MapKind::twist, MapKind::bend, MapKind::pull, MapKind::peel, MapKind::wave,
                               MapKind::knife, MapKind::seam})
        for (const TextureMapping& mapping : {TextureMapping{}, turned(), wound()})
            for (const glm::ivec3& size : {glm::ivec3(40, 33, 7), glm::ivec3(70, 64, 1)}) {
                const DeformationTexture texture = textureOf(kind, size);
                int shown = 0;
                EXPECT_EQ(shownOutside({&texture, mapping},
                                       ShownBounds(texture).of({&texture, mapping}, body), shown),
                          0)
                    << nameOf(kind) << ", radius " << mapping.cylinderRadius << ", " << size.x << " texels";
                EXPECT_GT(shown, 1000);
            }
}

// A few texels that have nothing to do with one another: what lies between them comes from anywhere between.
TEST(ShownBounds, HoldForAnyTexels) {
    const FieldBlocks body = bodyOf(round);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> way(-0.06, 0.06), mask(0, 1);
    for (int k = 0; k < 8; ++k) {
        std::vector<glm::dvec4> texels;
        for (int i = 0; i < 3 * 4 * 2; ++i)
            texels.emplace_back(way(random), way(random), way(random), mask(random));
        const auto texture =
            DeformationTexture::create({3, 4, 2}, glm::dvec3(0.1), TexelFormat::single, texels);
        ASSERT_TRUE(texture) << texture.error().message;
        int shown = 0;
        EXPECT_EQ(shownOutside({&*texture, {}}, ShownBounds(*texture).of({&*texture, {}}, body), shown), 0);
        EXPECT_GT(shown, 100);
    }
}

// A constant displacement of 10 mm: what is shown is the box, so much further on, but for blocks of texels.
TEST(ShownBounds, OfAMovedBoxAreThatBox) {
    const glm::ivec3 size(31);
    const auto texture =
        DeformationTexture::create(size, glm::dvec3(0.08), TexelFormat::single,
                                   std::vector<glm::dvec4>(std::size_t(31 * 31 * 31), {-0.01, 0, 0, 1}));
    ASSERT_TRUE(texture) << texture.error().message;
    const Bounds bounds = ShownBounds(*texture).of({&*texture, {}}, bodyOf(boxy));
    const glm::dvec3 texel = texture->texelSize() + 2 * kVoxel, by(0.01, 0, 0);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(bounds.lowest[axis], by[axis] - kBall[axis]);
        EXPECT_GE(bounds.highest[axis], by[axis] + kBall[axis]);
        EXPECT_GE(bounds.lowest[axis], by[axis] - kBall[axis] - texel[axis]);
        EXPECT_LE(bounds.highest[axis], by[axis] + kBall[axis] + texel[axis]);
    }
}

// All of a half is cut away: the bounds end a texel beyond.
TEST(ShownBounds, EndWhereTheMaskDoes) {
    const int n = 24;
    std::vector<glm::dvec4> texels;
    for (int i = 0; i < n * n * n; ++i)
        texels.emplace_back(0, 0, 0, i % n < n / 2 ? 1 : 0);
    const auto texture =
        DeformationTexture::create(glm::ivec3(n), glm::dvec3(0.06), TexelFormat::single, texels);
    ASSERT_TRUE(texture) << texture.error().message;
    const Bounds bounds = ShownBounds(*texture).of({&*texture, {}}, bodyOf(boxy));
    EXPECT_GE(bounds.highest.x, 0);
    EXPECT_LE(bounds.highest.x, texture->texelSize().x);
    EXPECT_LE(bounds.lowest.x, -kBall.x);
}

// Everything is taken from far away: nothing is shown, and the bounds say so.
TEST(ShownBounds, HaveNoSizeWhereNothingIsShown) {
    const auto texture = DeformationTexture::create(glm::ivec3(4), glm::dvec3(0.06), TexelFormat::single,
                                                    std::vector<glm::dvec4>(64, {0.115, 0, 0, 1}));
    ASSERT_TRUE(texture) << texture.error().message;
    const FieldBlocks body = bodyOf(round);
    const Bounds bounds = ShownBounds(*texture).of({&*texture, {}}, body);
    EXPECT_EQ(bounds.lowest, bounds.highest);
    EXPECT_EQ(bounds.lowest, body.bounds().lowest);
}

// A ball fills no corner of the box around it.
TEST(FieldBlocks, KnowWhereTheBodyIs) {
    const FieldBlocks body = bodyOf(round);
    const Bounds& bounds = body.bounds();
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(bounds.lowest[axis], -kRadius);
        EXPECT_GE(bounds.highest[axis], kRadius);
        EXPECT_LE(bounds.highest[axis] - bounds.lowest[axis], 2 * kRadius + 2.001 * kVoxel);
    }
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-0.05, 0.05), size(0, 0.004);
    int met = 0, passed = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 at(place(random), place(random), place(random)),
            half(size(random), size(random), size(random));
        const double nearest = glm::length(glm::max(glm::abs(at) - half, glm::dvec3(0)));
        const bool meets = body.meets({at - half, at + half});
        if (nearest < kRadius - 4e-5) {
            EXPECT_TRUE(meets) << at.x << ' ' << at.y << ' ' << at.z;
            ++met;
        } else if (nearest > kRadius + 5 * kVoxel) { // a block's diagonal
            EXPECT_FALSE(meets) << at.x << ' ' << at.y << ' ' << at.z;
            ++passed;
        }
    }
    EXPECT_GT(met, 3000);
    EXPECT_GT(passed, 300);
}

TEST(FieldBlocks, OfNothingMeetNothing) {
    const VolumeGrid grid = VolumeGrid::around(-kBall, kBall, 9, 1);
    const FieldBlocks none(grid, std::vector<float>(11 * 11 * 11, 1.0F)), whole(grid);
    EXPECT_FALSE(none.meets({glm::dvec3(-0.001), glm::dvec3(0.001)}));
    EXPECT_EQ(none.bounds().lowest, none.bounds().highest);
    EXPECT_TRUE(whole.meets({glm::dvec3(-0.001), glm::dvec3(0.001)}));
    EXPECT_FALSE(whole.meets({glm::dvec3(0.06), glm::dvec3(0.07)}));
}

} // namespace serosa::render
