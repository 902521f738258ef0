#include "render/camera.h"

#include <gtest/gtest.h>

namespace serosa::render {
namespace {

const glm::dvec3 kLowest(-0.05, 1.5, -0.2), kHighest(0.07, 1.7, -0.1); // m

glm::dvec3 project(const CameraView& view, const glm::dvec3& world) {
    const glm::dvec4 clip = view.clipFromCamera * view.cameraFromWorld * glm::dvec4(world, 1);
    return glm::dvec3(clip) / clip.w;
}

void expectFramed(const CameraView& view, double fills) {
    double largest = 0;
    for (int c = 0; c < 8; ++c) {
        const glm::dvec3 ndc = project(view, {c & 1 ? kHighest.x : kLowest.x, c & 2 ? kHighest.y : kLowest.y,
                                              c & 4 ? kHighest.z : kLowest.z});
        EXPECT_LE(std::abs(ndc.z), 1);
        largest = std::max({largest, std::abs(ndc.x), std::abs(ndc.y)});
    }
    EXPECT_NEAR(largest, fills, 1e-9);
}

TEST(Camera, DefaultFramingTouchesTheMargin) {
    for (const double aspect : {0.5, 1.0, 1.9})
        for (const auto projection : {sim::Projection::perspective, sim::Projection::orthographic}) {
            sim::Camera settings;
            settings.projection = projection;
            expectFramed(makeCamera(settings, kLowest, kHighest, aspect), 1 / 1.1);
        }
}

TEST(Camera, KnownPointsOfAPerspective) {
    sim::Camera settings;
    settings.eye = glm::dvec3(1, 2, 3);
    settings.target = glm::dvec3(1, 2, 0);
    settings.fieldOfView = 2 * std::atan(0.5);
    const CameraView view = makeCamera(settings, {0.5, 1.5, -0.5}, {1.5, 2.5, 0.5}, 2.0);
    EXPECT_NEAR(glm::distance(glm::dvec2(project(view, {1, 2, 0})), glm::dvec2(0, 0)), 0, 1e-12);
    // at distance 3 the picture is 3 m high and 6 m wide: x to the right, y up
    EXPECT_NEAR(glm::distance(glm::dvec2(project(view, {1, 3.5, 0})), glm::dvec2(0, 1)), 0, 1e-12);
    EXPECT_NEAR(glm::distance(glm::dvec2(project(view, {4, 2, 0})), glm::dvec2(1, 0)), 0, 1e-12);
    EXPECT_EQ(view.eye, *settings.eye);
}

TEST(Camera, OrthographicHeightIsWhatItSays) {
    sim::Camera settings;
    settings.projection = sim::Projection::orthographic;
    settings.direction = {0, 0, -2};
    settings.height = 0.5;
    const CameraView view = makeCamera(settings, kLowest, kHighest, 1.0);
    const glm::dvec3 centre = 0.5 * (kLowest + kHighest);
    EXPECT_NEAR(project(view, centre + glm::dvec3(0, 0.25, 0)).y, 1, 1e-12);
    EXPECT_NEAR(project(view, centre + glm::dvec3(0.125, 0, 0.01)).x, 0.5, 1e-12);
    EXPECT_LT(project(view, centre + glm::dvec3(0, 0, 0.05)).z, project(view, centre).z); // nearer is smaller
}

TEST(Camera, LookingAlongUpAndOfNoSizeIsFinite) {
    sim::Camera settings;
    settings.direction = {0, -1, 0};
    for (const CameraView& view :
         {makeCamera(settings, kLowest, kHighest, 1), makeCamera(settings, kLowest, kLowest, 1)})
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                EXPECT_TRUE(std::isfinite(view.cameraFromWorld[i][j]) &&
                            std::isfinite(view.clipFromCamera[i][j]));
}

} // namespace
} // namespace serosa::render
