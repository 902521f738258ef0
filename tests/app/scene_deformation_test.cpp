// A scene's deformations edited: elsewhere, more of them, points moved; what is wrong changes nothing.
#include "app/scene_deformation.h"

#include <gtest/gtest.h>

namespace serosa::app {
namespace {

sim::Scene sceneOf(sim::DeformationKind kind) {
    sim::Scene scene;
    scene.file = "scene.toml";
    sim::Deformation one;
    one.kind = kind;
    one.size = glm::dvec3(0.12);
    one.amount = 0.02;
    one.radius = 0.02;
    one.texels = glm::ivec3(16);
    one.reach = 0.03;
    one.points = {{glm::dvec3(0.01, 0, 0), glm::dvec3(0.015, 0, 0)}};
    one.line = 7;
    scene.deformations = {one};
    return scene;
}

TEST(SceneDeformation, IsEditedAndPutBack) {
    auto made = SceneDeformation::create(sceneOf(sim::DeformationKind::pull));
    ASSERT_TRUE(made) << made.error().message;
    const double before = made->texture(0)->largest();
    sim::Deformation now = made->deformation(0);
    now.keys = {{0, {0.01, 0.02, 0.03}, 0.5, 2}};
    ASSERT_TRUE(made->edit(0, now).ok());
    const auto warp = made->at(0, 0.1);
    ASSERT_TRUE(warp);
    EXPECT_EQ(glm::dvec3((*warp)->mapping.objectFromLocal[3]), glm::dvec3(0.01, 0.02, 0.03));
    EXPECT_NEAR(glm::length(glm::dvec3((*warp)->mapping.objectFromLocal[0])), 2, 1e-12);
    EXPECT_EQ(made->texture(0)->largest(), before) << "of the same map";
    now.amount = 0.01;
    ASSERT_TRUE(made->edit(0, now).ok());
    EXPECT_NEAR(made->texture(0)->largest(), 0.5 * before, 0.05 * before);
    const int version = made->version();
    EXPECT_EQ(version, 2);
    ASSERT_TRUE(made->restore().ok());
    EXPECT_GT(made->version(), version);
    EXPECT_EQ(made->texture(0)->largest(), before);
    EXPECT_EQ(glm::dvec3((*made->at(0, 0.1))->mapping.objectFromLocal[3]), glm::dvec3(0));
}

TEST(SceneDeformation, WhatFoldsChangesNothing) {
    auto made = SceneDeformation::create(sceneOf(sim::DeformationKind::pull));
    ASSERT_TRUE(made) << made.error().message;
    const double before = made->texture(0)->largest();
    sim::Deformation now = made->deformation(0);
    now.amount = 0.3;
    const Status edited = made->edit(0, now);
    ASSERT_FALSE(edited.ok());
    EXPECT_EQ(edited.error().message.rfind("scene.toml:7: deformation: ", 0), 0U) << edited.error().message;
    EXPECT_EQ(made->version(), 0);
    EXPECT_EQ(made->deformation(0).amount, 0.02);
    EXPECT_EQ(made->texture(0)->largest(), before);
}

TEST(SceneDeformation, PointsAreMoved) {
    auto made = SceneDeformation::create(sceneOf(sim::DeformationKind::points));
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->name(0), "points");
    sim::Deformation now = made->deformation(0);
    const auto shownAt = [&](const glm::dvec3& shown) { return (*made->at(0, 0))->at(shown).rest; };
    EXPECT_NEAR(shownAt({0.015, 0, 0}).x, 0.01, 0.002);
    now.points[0].second = {0.01, 0.005, 0};
    ASSERT_TRUE(made->edit(0, now).ok());
    EXPECT_NEAR(shownAt({0.01, 0.005, 0}).y, 0, 0.002);
    EXPECT_NEAR(shownAt({0.01, 0.005, 0}).x, 0.01, 0.002);
}

} // namespace
} // namespace serosa::app
