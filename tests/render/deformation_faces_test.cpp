// What is said of a deformation's box: torn faces, folds; several deformations as one.
#include "render/deformation_chain.h"
#include "render/deformation_faces.h"
#include "render/stage_box.h"

#include <gtest/gtest.h>

#include <cmath>

namespace serosa::render {
namespace {

DeformationMap pull() {
    DeformationMap map;
    map.kind = MapKind::pull;
    map.half = {0.04, 0.05, 0.04};
    map.amount = 0.02;
    map.radius = 0.01;
    return map;
}

DeformationTexture baked(const DeformationMap& map, const glm::ivec3& size = glm::ivec3(32)) {
    Result<DeformationTexture> made = DeformationTexture::bake(map, size, TexelFormat::single);
    EXPECT_TRUE(made.ok()) << made.error().message;
    return std::move(made).value();
}

auto ball(double radius, const glm::dvec3& middle = glm::dvec3(0)) {
    return [radius, middle](const glm::dvec3& p) { return glm::distance(p, middle) < radius; };
}

TEST(DeformationFaces, SayWhereAnObjectIsTorn) {
    const DeformationTexture texture = baked(pull());
    Warp warp{&texture, {}};
    warp.mapping.objectFromLocal[3] = {0.1, 0, 0, 1};
    const auto clear = examineFaces(warp, ball(0.045, {0.1, 0, 0}));
    EXPECT_EQ(tornFaces(clear), "") << "the top lies outside of the ball";
    for (int face = 0; face < 6; ++face)
        EXPECT_EQ(clear[std::size_t(face)].still, zeroFaces(pull()).zero[face]) << face;
    // Grown through the top: torn there and nowhere else, by as much as the pull does there.
    const auto torn = examineFaces(warp, ball(0.055, {0.1, 0, 0}));
    for (int face = 0; face < 6; ++face)
        EXPECT_EQ(torn[std::size_t(face)].tears, face == 3) << face;
    EXPECT_NEAR(torn[3].moved, 0.02, 0.002);
    EXPECT_NEAR(torn[3].at.y, 0.05, 1e-6);
    EXPECT_NEAR(torn[3].at.x, 0.1, 0.01);
    EXPECT_NE(tornFaces(torn).find("+y"), std::string::npos);
    // Of a ball that the pull draws out through the top, what is drawn ends there.
    EXPECT_EQ(endingFaces(clear).rfind("+y at (", 0), 0U) << endingFaces(clear);
    EXPECT_NEAR(clear[3].endsAt.y, 0.05, 1e-6);
    EXPECT_EQ(endingFaces(examineFaces(warp, ball(0.02, {0.1, 0, 0}))), "");
    // A texture that is constant along an axis does not vanish on its faces.
    const DeformationTexture flat = baked(pull(), {32, 32, 1});
    EXPECT_FALSE(examineFaces({&flat, {}}, ball(0.01))[4].still);
    // Cut without motion, through a face.
    DeformationMap box = pull();
    box.kind = MapKind::box;
    box.extent = 0.2;
    box.depth = box.width = 0.02;
    const DeformationTexture slot = baked(box);
    const auto cut = examineFaces({&slot, {}}, ball(0.06));
    EXPECT_TRUE(cut[0].tears && cut[1].tears);
    EXPECT_FALSE(cut[2].tears || cut[3].tears || cut[4].tears || cut[5].tears);
    // Narrower than a 24th of the face, but not than a texel.
    box.extent = 0.003;
    box.depth = 0.2;
    const DeformationTexture narrow = baked(box, glm::ivec3(64));
    const auto slit = examineFaces({&narrow, {}}, ball(0.06));
    EXPECT_TRUE(slit[2].tears && slit[3].tears);
    // A whole turn around a cylinder has no ends.
    DeformationMap twist = pull();
    twist.kind = MapKind::wave;
    twist.extent = 0.02;
    twist.amount = 0.01;
    twist.half.z = 3.15 * 0.1;
    const DeformationTexture ring = baked(twist, {32, 32, 1});
    Warp wound{&ring, {}};
    EXPECT_FALSE(examineFaces(wound, ball(1))[4].still);
    wound.mapping.cylinderRadius = 0.1;
    EXPECT_TRUE(examineFaces(wound, ball(1))[4].still);
}

TEST(DeformationFaces, SeamsLieWhereNothingMoves) {
    const DeformationTexture texture = baked(pull());
    Warp warp{&texture, {}};
    warp.mapping.objectFromLocal[0] *= 2.0;
    const StageBox box = StageBox::of(warp, examineFaces(warp, ball(0.01)), 0.006);
    EXPECT_EQ(box.seamLow, glm::dvec3(0.003, 0.006, 0.006));
    EXPECT_EQ(box.seamHigh, glm::dvec3(0.003, 0, 0.006));
    const Bounds bounds = box.mapping.boundsOf(box.half);
    EXPECT_LT(glm::distance(bounds.lowest, {-0.08, -0.05, -0.04}), 1e-12);
    EXPECT_LT(glm::distance(bounds.highest, {0.08, 0.05, 0.04}), 1e-12);
}

TEST(DeformationFaces, FoldsAreCounted) {
    EXPECT_EQ(foldedShare(baked(pull())), 0);
    // x = x' - 0.02 sin(400 x'): slope 1 - 8 cos: turned inside out for |phase| < acos(1/8), 46% of a period.
    std::vector<glm::dvec4> texels;
    const double half = 2 * 2 * 3.14159265358979 / 400;
    for (int i = 0; i < 256; ++i)
        texels.emplace_back(-0.02 * std::sin(400 * ((i + 0.5) / 128 - 1) * half), 0, 0, 1);
    const auto folded =
        DeformationTexture::create({256, 1, 1}, glm::dvec3(half), TexelFormat::single, texels);
    ASSERT_TRUE(folded.ok());
    EXPECT_NEAR(foldedShare(*folded), std::acos(1.0 / 8) / 3.14159265, 0.03);
    // What it shows is defined: a backward map has one rest for each place.
    const Warp warp{&*folded, {}};
    const glm::dvec3 at(0.001, 0, 0);
    EXPECT_NEAR(warp.at(at).rest.x, 0.001 - 0.02 * std::sin(0.4), 1e-4);
}

TEST(DeformationChain, ComposesWarps) {
    DeformationMap twist = pull();
    twist.kind = MapKind::twist;
    twist.amount = 0.7;
    DeformationMap slot = pull();
    slot.kind = MapKind::sphere;
    slot.radius = 0.015;
    const DeformationTexture a = baked(twist, glm::ivec3(48)), b = baked(slot, glm::ivec3(48));
    Warp first{&a, {}}, second{&b, {}};
    second.mapping.objectFromLocal = {{0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}, {0.05, 0.01, 0, 1}};
    const auto both = chain({first, second}, TexelFormat::single);
    ASSERT_TRUE(both.ok()) << both.error().message;
    const Warp one{&both->texture, both->mapping};
    double most = 0;
    int kept = 0, cut = 0, differ = 0;
    for (int i = 0; i < 4000; ++i) {
        const auto number = [i](double by) { return 2 * (i * by - std::floor(i * by)) - 1; };
        // Below the top of the twist's box, on which it does not vanish.
        const glm::dvec3 p(0.025 + 0.07 * number(0.7071), 0.046 * number(0.618), 0.045 * number(0.2679));
        const Warp::Point last = second.at(p), then = first.at(last.rest), chained = one.at(p);
        most = std::max(most, glm::distance(then.rest, chained.rest));
        const bool keeps = std::min(last.mask, then.mask) >= 0.5;
        (keeps ? kept : cut) += 1;
        differ += keeps != (chained.mask >= 0.5);
    }
    EXPECT_LT(most, 4e-4) << "m: sampled anew, with texels of 1.7 mm";
    EXPECT_GT(cut, 30);
    EXPECT_LT(differ, 4);
    EXPECT_EQ(one.at({0.2, 0, 0}).rest, glm::dvec3(0.2, 0, 0));
}

} // namespace
} // namespace serosa::render
