// The camera that the user turns: what a drag does to the picture, by projecting points.

#include "app/frame_clock.h"
#include "app/orbit_camera.h"
#include "app/view_input.h"
#include "render/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace serosa::app {
namespace {

const glm::dvec3 kLowest(-0.05, -0.02, -0.03), kHighest(0.07, 0.06, 0.05); // m
constexpr double kAspect = 1.5;

std::vector<sim::Camera> cameras() {
    sim::Camera plain, placed, flat, tilted;
    placed.eye = glm::dvec3(0.1, 0.2, 0.4);
    placed.target = glm::dvec3(0, 0.03, 0);
    flat.projection = sim::Projection::orthographic;
    tilted.up = {0.2, 0.3, 1};
    tilted.direction = {1, 0.4, -0.2};
    tilted.zoom = 1.7;
    return {plain, placed, flat, tilted};
}

render::CameraView viewOf(const OrbitCamera& camera) {
    return render::makeCamera(camera.settings(), kLowest, kHighest, kAspect);
}

glm::dvec2 projected(const render::CameraView& view, const glm::dvec3& point) {
    const glm::dvec4 clip = view.clipFromCamera * view.cameraFromWorld * glm::dvec4(point, 1);
    return glm::dvec2(clip) / clip.w;
}

glm::dvec3 targetOf(const sim::Camera& scene) {
    return scene.target.value_or(0.5 * (kLowest + kHighest));
}

double largestDifference(const glm::dmat4& a, const glm::dmat4& b) {
    double largest = 0;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            largest = std::max(largest, std::abs(a[c][r] - b[c][r]));
    return largest;
}

TEST(OrbitCamera, UntouchedIsTheScenesCameraExactly) {
    for (const sim::Camera& scene : cameras()) {
        OrbitCamera camera(scene, kLowest, kHighest, kAspect);
        const render::CameraView expected = render::makeCamera(scene, kLowest, kHighest, kAspect);
        EXPECT_EQ(viewOf(camera).cameraFromWorld, expected.cameraFromWorld);
        EXPECT_EQ(viewOf(camera).clipFromCamera, expected.clipFromCamera);
        camera.orbit({0.3, 0.2});
        camera.zoom(2);
        EXPECT_GT(largestDifference(viewOf(camera).cameraFromWorld, expected.cameraFromWorld), 1e-3);
        camera.reset();
        EXPECT_EQ(viewOf(camera).cameraFromWorld, expected.cameraFromWorld);
        EXPECT_EQ(viewOf(camera).clipFromCamera, expected.clipFromCamera);
    }
}

TEST(OrbitCamera, TheFirstTouchDoesNotJump) {
    for (const sim::Camera& scene : cameras()) {
        OrbitCamera camera(scene, kLowest, kHighest, kAspect);
        const render::CameraView before = viewOf(camera);
        camera.orbit({0, 0});
        camera.zoom(1);
        camera.pan({0, 0});
        for (const glm::dvec3& point : {kLowest, kHighest, glm::dvec3(0)})
            EXPECT_LT(glm::length(projected(viewOf(camera), point) - projected(before, point)), 1e-9);
    }
}

TEST(OrbitCamera, APanKeepsThePointUnderThePointer) {
    for (const sim::Camera& scene : cameras()) {
        OrbitCamera camera(scene, kLowest, kHighest, kAspect);
        const glm::dvec3 grasped = targetOf(scene);
        camera.zoom(1.4);
        const glm::dvec2 before = projected(viewOf(camera), grasped);
        camera.pan({0.25, 0.1}); // heights of the window; a height is 2 in y, 2 / aspect in x
        const glm::dvec2 moved = projected(viewOf(camera), grasped) - before;
        EXPECT_NEAR(moved.x, 2 * 0.25 / kAspect, 1e-9);
        EXPECT_NEAR(moved.y, 2 * 0.1, 1e-9);
    }
}

TEST(OrbitCamera, HalfAWindowIsAQuarterTurnAboutUp) {
    for (const sim::Camera& scene : cameras()) {
        OrbitCamera camera(scene, kLowest, kHighest, kAspect);
        const glm::dvec3 target = targetOf(scene), up = glm::normalize(scene.up);
        const glm::dvec3 before = viewOf(camera).eye - target;
        camera.orbit({0.5, 0});
        const glm::dvec3 after = *camera.settings().eye - target;
        EXPECT_NEAR(glm::length(after), glm::length(before), 1e-12);
        EXPECT_NEAR(glm::dot(after, up), glm::dot(before, up), 1e-12) << "the height stays";
        const glm::dvec3 a = before - glm::dot(before, up) * up, b = after - glm::dot(after, up) * up;
        EXPECT_NEAR(glm::dot(a, b), 0, 1e-12) << "a quarter turn";
    }
}

TEST(OrbitCamera, TheOrganFollowsThePointer) {
    for (const sim::Camera& scene : cameras())
        for (const glm::dvec2 by : {glm::dvec2(0.02, 0), glm::dvec2(0, 0.02)}) {
            OrbitCamera camera(scene, kLowest, kHighest, kAspect);
            const render::CameraView before = viewOf(camera);
            const glm::dvec3 target = targetOf(scene);
            const glm::dvec3 front = target + 0.1 * (before.eye - target); // nearer than the target
            camera.orbit(by);
            const glm::dvec2 moved = projected(viewOf(camera), front) - projected(before, front);
            EXPECT_GT(glm::dot(moved, by), 0);
            EXPECT_GT(std::abs(glm::dot(moved, by)), 5 * std::abs(moved.x * by.y - moved.y * by.x))
                << "in that direction";
        }
}

TEST(OrbitCamera, StopsShortOfThePoles) {
    for (const sim::Camera& scene : cameras())
        for (const double sign : {1.0, -1.0}) {
            OrbitCamera camera(scene, kLowest, kHighest, kAspect);
            for (int i = 0; i < 50; ++i)
                camera.orbit({0.01, sign * 0.2});
            const glm::dvec3 direction = glm::normalize(*camera.settings().target - *camera.settings().eye);
            const double fromUp = std::acos(glm::dot(direction, glm::normalize(scene.up)));
            const double pole = sign > 0 ? 0 : std::numbers::pi;
            EXPECT_NEAR(std::abs(fromUp - pole), 2 * std::numbers::pi / 180, 1e-6);
        }
}

TEST(OrbitCamera, ZoomsByTheFactorUpToLimits) {
    for (const sim::Camera& scene : cameras()) {
        OrbitCamera camera(scene, kLowest, kHighest, kAspect);
        camera.zoom(1);
        const glm::dvec3 target = targetOf(scene);
        const glm::dmat4 worldFromCamera = glm::inverse(viewOf(camera).cameraFromWorld);
        const glm::dvec3 beside = target + 0.01 * glm::dvec3(worldFromCamera[0]);
        const auto size = [&] {
            return glm::length(projected(viewOf(camera), beside) - projected(viewOf(camera), target));
        };
        const double before = size();
        camera.zoom(2);
        EXPECT_NEAR(size() / before, 2, 1e-9);
        for (int i = 0; i < 100; ++i)
            camera.zoom(2);
        const double nearest = size();
        camera.zoom(2);
        EXPECT_DOUBLE_EQ(size(), nearest);
        EXPECT_TRUE(std::isfinite(nearest));
        for (int i = 0; i < 100; ++i)
            camera.zoom(0.5);
        EXPECT_NEAR(nearest / size(), 2500, 1e-6);
    }
}

TEST(FrameClock, GivesWholeFramesHoweverTheTimeIsCut) {
    FrameClock even(0.01, 100), uneven(0.01, 100);
    int evenFrames = 0, unevenFrames = 0;
    for (int i = 0; i < 1000; ++i)
        evenFrames += even.due(0.0125);
    for (int i = 0; i < 1000; ++i)
        unevenFrames += uneven.due(i % 3 == 0 ? 0.0005 : i % 3 == 1 ? 0.001 : 0.036);
    EXPECT_EQ(evenFrames, 1250);
    EXPECT_NEAR(unevenFrames, 1000 * 0.0125 / 0.01, 2);
    EXPECT_GT(even.untilNext(), 0);
    EXPECT_LE(even.untilNext(), 0.01);
}

TEST(FrameClock, DropsWhatItOwesTooMuch) {
    FrameClock clock(0.01, 4);
    EXPECT_EQ(clock.due(10), 4);
    EXPECT_EQ(clock.due(0), 0);
    EXPECT_EQ(clock.due(-5), 0);
    EXPECT_EQ(clock.due(0.009), 0);
    clock.restart();
    EXPECT_EQ(clock.due(0.009), 0) << "nothing is owed after a pause";
    EXPECT_EQ(clock.due(0.0011), 1);
}

class ViewInputTest : public ::testing::Test {
protected:
    void key(int code, bool repeated = false) {
        gpu::WindowEvent event;
        event.kind = gpu::WindowEvent::Kind::keyPressed;
        event.key = code;
        event.repeated = repeated;
        input.take(event, 100, false);
    }
    void pointer(gpu::WindowEvent::Kind kind, const glm::dvec2& at, bool taken = false,
                 gpu::MouseButton button = gpu::MouseButton::left) {
        gpu::WindowEvent event;
        event.kind = kind;
        event.at = at;
        event.button = button;
        input.take(event, 100, taken);
    }
    bool moved() const { return camera.settings().eye.has_value(); }
    ViewControls controls;
    OrbitCamera camera{sim::Camera{}, kLowest, kHighest, kAspect};
    ViewInput input{controls, camera};
};

using Kind = gpu::WindowEvent::Kind;

TEST_F(ViewInputTest, KeysSetTheSwitches) {
    key(' ');
    EXPECT_TRUE(controls.paused);
    key(' ', true);
    EXPECT_TRUE(controls.paused) << "held down, it does not flicker";
    key(' ');
    EXPECT_FALSE(controls.paused);
    key('1');
    EXPECT_EQ(controls.look.mapping, sim::Mapping::oneToOne);
    key('2');
    EXPECT_EQ(controls.look.mapping, sim::Mapping::triangle);
    key('3');
    EXPECT_EQ(controls.look.mapping, sim::Mapping::curvature);
    controls.sceneMapping = sim::Mapping::nodeFrames;
    key('4');
    EXPECT_EQ(controls.look.mapping, sim::Mapping::nodeFrames);
    for (const auto& [code, isOn] :
         std::vector<std::pair<int, const bool*>>{{'r', &controls.restart},
                                                  {'l', &controls.look.lattice},
                                                  {'w', &controls.wireframe},
                                                  {'s', &controls.picture},
                                                  {gpu::keyF12, &controls.windowPicture},
                                                  {gpu::keyF5, &controls.reload},
                                                  {'c', &controls.resetCamera},
                                                  {'q', &controls.quit}}) {
        EXPECT_FALSE(*isOn);
        key(code);
        EXPECT_TRUE(*isOn) << code;
    }
    key('.');
    key('.', true);
    EXPECT_EQ(controls.steps, 2);
    key('p');
    EXPECT_FALSE(controls.panel);
    key('n');
    EXPECT_EQ(controls.look.colour, sim::SurfaceColour::dynamicNormal);
    key(0); // a key without a name
    EXPECT_FALSE(moved());
}

TEST_F(ViewInputTest, DragsTurnOrMoveUnlessThePanelHasThem) {
    pointer(Kind::moved, {50, 50});
    EXPECT_FALSE(moved()) << "no button is down";
    pointer(Kind::buttonPressed, {50, 50}, true);
    pointer(Kind::moved, {60, 50});
    EXPECT_FALSE(moved()) << "the panel's";
    pointer(Kind::buttonReleased, {60, 50});
    pointer(Kind::buttonPressed, {60, 50});
    pointer(Kind::moved, {70, 50}, true); // over the panel by now
    ASSERT_TRUE(moved());
    EXPECT_EQ(*camera.settings().target, 0.5 * (kLowest + kHighest)) << "a turn";
    pointer(Kind::buttonReleased, {70, 50});
    const glm::dvec3 eye = *camera.settings().eye;
    pointer(Kind::moved, {90, 90});
    EXPECT_EQ(*camera.settings().eye, eye);
    pointer(Kind::buttonPressed, {90, 90}, false, gpu::MouseButton::right);
    pointer(Kind::moved, {90, 80});
    EXPECT_GT(glm::length(*camera.settings().target - 0.5 * (kLowest + kHighest)), 1e-3) << "a move";
}

TEST_F(ViewInputTest, TheWheelZoomsAndMovesNoPointer) {
    pointer(Kind::moved, {50, 50});
    pointer(Kind::scrolled, {0, 1}, true);
    EXPECT_FALSE(moved());
    pointer(Kind::scrolled, {0, 1});
    ASSERT_TRUE(moved());
    const glm::dvec3 eye = *camera.settings().eye;
    pointer(Kind::buttonPressed, {50, 50});
    pointer(Kind::moved, {50, 50});
    EXPECT_LT(glm::length(*camera.settings().eye - eye), 1e-12);
}

} // namespace
} // namespace serosa::app
