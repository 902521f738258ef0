// Deformation textures: what formats hold, sums, the mapping M and its Jacobian, control points, inverted
// displacements, bad input.
#include "render/deformation_sources.h"
#include "render/deformation_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace serosa::render {
namespace {

DeformationMap twist() {
    DeformationMap map;
    map.kind = MapKind::twist;
    map.half = {0.05, 0.06, 0.05};
    map.amount = 0.6;
    return map;
}

TEST(DeformationTexture, HoldsAMapAsWellAsItsFormatCan) {
    const struct {
        TexelFormat format;
        std::size_t bytes;
        double error; // of the largest component
    } kFormats[] = {{TexelFormat::unorm8, 4, 0.5 / 127},
                    {TexelFormat::half, 8, 1.0 / 2048},
                    {TexelFormat::single, 16, 1e-7}};
    const DeformationMap map = twist();
    for (const auto& [format, bytes, error] : kFormats) {
        const auto texture = DeformationTexture::bake(map, {20, 24, 28}, format);
        ASSERT_TRUE(texture.ok()) << texture.error().message;
        EXPECT_EQ(texture->bytes(), bytes * 20 * 24 * 28);
        EXPECT_FALSE(texture->cuts());
        double most = 0;
        for (int z = 0; z < 28; ++z)
            for (int y = 0; y < 24; ++y)
                for (int x = 0; x < 20; ++x) {
                    const glm::dvec3 q = (glm::dvec3(x, y, z) + 0.5) * texture->texelSize() - map.half;
                    const glm::dvec3 off =
                        glm::abs(glm::dvec3(texture->sample(q)) - inverseDisplacement(map, q));
                    most = std::max({most, off.x, off.y, off.z});
                }
        EXPECT_LT(most, 1.01 * error * texture->scale());
    }
    // CS07: a peel of 128 KB, which is constant along z, and a twist of 2 MB.
    DeformationMap peel;
    peel.kind = MapKind::peel;
    peel.radius = 0.5;
    peel.depth = 0.8;
    EXPECT_EQ(DeformationTexture::bake(peel, {128, 128, 1}, TexelFormat::half)->bytes(), 128u * 1024);
    EXPECT_EQ(DeformationTexture::bake(map, {64, 64, 64}, TexelFormat::half)->bytes(), 2048u * 1024);
}

TEST(DeformationTexture, AddsUp) {
    DeformationMap wave = twist();
    wave.kind = MapKind::wave;
    wave.amount = 0.004;
    wave.extent = 0.03;
    const auto a = DeformationTexture::bake(twist(), {16, 16, 16}, TexelFormat::single),
               b = DeformationTexture::bake(wave, {16, 16, 16}, TexelFormat::single);
    ASSERT_TRUE(a.ok() && b.ok());
    const auto both = DeformationTexture::sum(*a, *b);
    ASSERT_TRUE(both.ok());
    const glm::dvec3 q(0.01, 0.03, -0.02);
    EXPECT_LT(glm::distance(both->sample(q), a->sample(q) + b->sample(q) - glm::dvec4(0, 0, 0, 1)), 1e-8);
    const auto other = DeformationTexture::bake(wave, {16, 16, 8}, TexelFormat::single);
    EXPECT_FALSE(DeformationTexture::sum(*a, *other).ok());
}

TEST(DeformationTexture, TheWholeMapHasItsJacobian) {
    // A linear displacement: trilinear interpolation and differences over a texel are exact.
    const glm::ivec3 size(32);
    const glm::dvec3 half(0.06);
    const glm::dmat3 slope(0.2, -0.1, 0.05, 0.1, 0.15, -0.2, -0.05, 0.1, -0.15);
    std::vector<glm::dvec4> texels;
    for (int z = 0; z < 32; ++z)
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x)
                texels.emplace_back(slope * ((glm::dvec3(x, y, z) + 0.5) * 2.0 * half / 32.0 - half), 1);
    const auto texture = DeformationTexture::create(size, half, TexelFormat::single, texels);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    for (const double wound : {0.0, 0.08}) {
        Warp warp{&*texture, {}};
        warp.mapping.objectFromLocal = {
            {0, 1.2, 0, 0}, {-0.9, 0, 0, 0}, {0, 0, 1.1, 0}, {0.01, 0.02, 0.03, 1}};
        warp.mapping.cylinderRadius = wound;
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 q(0.05 * std::sin(3 * i), 0.05 * std::sin(5 * i + 1), 0.05 * std::sin(7 * i));
            const glm::dvec3 shown = warp.mapping.toObject(q);
            EXPECT_LT(glm::distance(warp.mapping.toTexture(shown), q), 1e-12);
            const glm::dmat3 j = warp.jacobian(shown);
            const double step = 1e-5;
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 by(0);
                by[axis] = step;
                const glm::dvec3 apart = (warp.at(shown + by).rest - warp.at(shown - by).rest) / (2 * step);
                EXPECT_LT(glm::distance(apart, j[axis]), 1e-5) << i;
            }
        }
        // Outside of the box nothing moves.
        const glm::dvec3 far = warp.mapping.toObject({0, 0.07, 0});
        EXPECT_EQ(warp.at(far).rest, far);
        EXPECT_EQ(warp.at(far).mask, 1);
    }
    // As printed, eq. 2 moves p by M's translation, too: p' + M(D(M^-1 p')). A texture of zeros must not
    // move.
    const auto still =
        DeformationTexture::create({1, 1, 1}, glm::dvec3(0.1), TexelFormat::half, {glm::dvec4(0, 0, 0, 1)});
    Warp warp{&*still, {}};
    warp.mapping.objectFromLocal[3] = glm::dvec4(0.05, 0, 0, 1);
    EXPECT_EQ(warp.at({0.06, 0.01, 0}).rest, glm::dvec3(0.06, 0.01, 0));
}

TEST(DeformationTexture, ControlPointsGoWhereTheyWereMoved) {
    const glm::dvec3 half(0.05);
    const glm::ivec3 size(41); // control points at texels' middles
    const auto middle = [&](int x, int y, int z) {
        return (glm::dvec3(x, y, z) + 0.5) * 2.0 * half / glm::dvec3(size) - half;
    };
    const std::vector<ControlPoint> points = {{middle(20, 20, 20), middle(22, 20, 20)},
                                              {middle(12, 20, 26), middle(12, 20, 26)}};
    const auto texture = interpolateControlPoints(points, size, half, 0.03, TexelFormat::single);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    for (const ControlPoint& point : points)
        EXPECT_LT(glm::distance(point.to + glm::dvec3(texture->sample(point.to)), point.from), 1e-8);
    EXPECT_EQ(glm::dvec3(texture->sample(middle(40, 20, 20))), glm::dvec3(0)) << "far away, on the face";
    EXPECT_FALSE(interpolateControlPoints({}, size, half, 0.03, TexelFormat::half).ok());
    EXPECT_FALSE(interpolateControlPoints({points[0], points[0]}, size, half, 0.03, TexelFormat::half).ok());
    EXPECT_FALSE(
        interpolateControlPoints({{{0, 0, 0}, {1, 0, 0}}}, size, half, 0.03, TexelFormat::half).ok());
}

TEST(DeformationTexture, InvertsAForwardDisplacement) {
    const glm::ivec3 size(40);
    const glm::dvec3 half(0.05, 0.06, 0.05);
    // A bump that vanishes on all faces of the box.
    const auto moved = [&half](const glm::dvec3& p) {
        const glm::dvec3 s = 1.0 - (p / half) * (p / half);
        const double bump = s.x * s.x * s.y * s.y * s.z * s.z;
        return bump * glm::dvec3(0.01, -0.006, 0.004);
    };
    std::vector<glm::dvec3> displacement;
    for (int z = 0; z < 40; ++z)
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                displacement.push_back(moved((glm::dvec3(x, y, z) + 0.5) * 2.0 * half / 40.0 - half));
    const auto inverted = invertDisplacement(displacement, size, half, TexelFormat::single);
    ASSERT_TRUE(inverted.ok()) << inverted.error().message;
    EXPECT_EQ(inverted->residual.unresolved, 0u);
    EXPECT_LT(inverted->residual.largest, 1e-8);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 p(0.04 * std::sin(3 * i), 0.05 * std::sin(5 * i), 0.04 * std::sin(7 * i + 1));
        const glm::dvec3 shown = p + moved(p);
        EXPECT_LT(glm::distance(shown + glm::dvec3(inverted->texture.sample(shown)), p), 1e-4);
    }
    // One that folds: the residual says so, and all is finite.
    for (std::size_t i = 0; i < displacement.size(); ++i)
        displacement[i] = {0.045 * std::sin(0.9 * double(i % 40)), 0, 0};
    const auto folded = invertDisplacement(displacement, size, half, TexelFormat::single);
    ASSERT_TRUE(folded.ok());
    EXPECT_GT(folded->residual.unresolved, 10u);
}

TEST(DeformationTexture, BadInputIsSaid) {
    const auto message = [](const Result<DeformationTexture>& made) {
        return made.ok() ? std::string() : made.error().message;
    };
    const std::vector<glm::dvec4> one = {glm::dvec4(0, 0, 0, 1)};
    EXPECT_NE(message(DeformationTexture::create({0, 1, 1}, glm::dvec3(1), TexelFormat::half, {}))
                  .find("at least 1"),
              std::string::npos);
    EXPECT_NE(message(DeformationTexture::create({1, 1, 2}, glm::dvec3(1), TexelFormat::half, one)), "");
    EXPECT_TRUE(DeformationTexture::create({1, 1, 1}, glm::dvec3(1), TexelFormat::half, one).ok());
    EXPECT_NE(message(DeformationTexture::create({1, 1, 1}, {1, 0, 1}, TexelFormat::half, one)), "");
    const std::vector<glm::dvec4> nothing = {glm::dvec4(0, std::numeric_limits<double>::quiet_NaN(), 0, 1)};
    EXPECT_NE(message(DeformationTexture::create({1, 1, 1}, glm::dvec3(1), TexelFormat::half, nothing))
                  .find("texel (0, 0, 0)"),
              std::string::npos);
    EXPECT_NE(message(DeformationTexture::create({1, 1, 1}, glm::dvec3(1), TexelFormat::half,
                                                 {glm::dvec4(3, 0, 0, 1)}))
                  .find("larger"),
              std::string::npos);
    EXPECT_NE(message(DeformationTexture::create({1, 1, 1}, glm::dvec3(1), TexelFormat::half,
                                                 {glm::dvec4(0, 0, 0, 0)}))
                  .find("everything"),
              std::string::npos);
    DeformationMap folding;
    folding.kind = MapKind::pull;
    folding.amount = 2;
    EXPECT_NE(message(DeformationTexture::bake(folding, {8, 8, 8}, TexelFormat::half)).find("folds"),
              std::string::npos);
}

} // namespace
} // namespace serosa::render
