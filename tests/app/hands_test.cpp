// The user's hands without a window: rays and hits, speed and paths of the hands, and a hand on a block by
// the reference solver.

#include "app/hands.h"
#include "app/surface_pick.h"
#include "sim/solver.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

namespace serosa::app {
namespace {

TEST(SurfacePick, MeetsThePlaneOfTheDrag) {
    EXPECT_EQ(onPlane({{0, 0, 5}, {0, 0, -1}}, {3, 3, 2}, {0, 0, 1}), glm::dvec3(0, 0, 2));
    EXPECT_EQ(onPlane({{0, 0, 5}, {1, 0, 0}}, {3, 3, 2}, {0, 0, 1}), glm::dvec3(3, 3, 2)) << "along it";
}

// The ray through the place where a point is drawn goes through the point.
TEST(SurfacePick, RaysGoThroughWhatIsDrawnThere) {
    for (const sim::Projection projection : {sim::Projection::perspective, sim::Projection::orthographic}) {
        sim::Camera settings;
        settings.projection = projection;
        const render::CameraView camera = render::makeCamera(settings, {-0.1, 1, -0.1}, {0.1, 1.2, 0.1}, 1.5);
        const glm::dvec3 point(0.03, 1.15, -0.05);
        const glm::dvec4 clip = camera.clipFromCamera * camera.cameraFromWorld * glm::dvec4(point, 1);
        const glm::dvec2 at(150 * (1 + clip.x / clip.w), 100 * (1 - clip.y / clip.w));
        const Ray ray = rayThrough(camera, at, {300, 200});
        EXPECT_LT(glm::length(glm::cross(point - ray.from, ray.along)), 1e-9);
    }
}

TEST(Hands, FollowTheirTargetNoFasterThanTheyMay) {
    Hands hands(0.004, 0.2, 5000);
    EXPECT_FALSE(hands.active());
    const sim::Tool &grasp = hands.tools()[0], &probe = hands.tools()[1];
    EXPECT_EQ(grasp.mode, sim::ToolMode::grasp);
    EXPECT_TRUE(std::isfinite(grasp.gripForce));
    hands.begin(HandKind::grasp, 1, {0, 0, 0}, {0, 0, 1});
    EXPECT_TRUE(grasp.activeAt(1));
    hands.moveTo({0.001, 0, 0});
    hands.sample(1.1);
    EXPECT_EQ(grasp.poseAt(1.1).at, glm::dvec3(0.001, 0, 0));
    hands.moveTo({50, 0, 0});
    hands.sample(1.2);
    EXPECT_NEAR(grasp.poseAt(1.2).at.x, 0.001 + 0.1 * 2.5 * 0.2, 1e-12);
    hands.end(1.2);
    EXPECT_TRUE(grasp.activeAt(1.19));
    EXPECT_FALSE(grasp.activeAt(1.2));
    // The finger begins outside of what it touches, on the eye's side.
    hands.begin(HandKind::probe, 2, {0, 0, 0}, {0, 0, 1});
    EXPECT_FALSE(grasp.activeAt(2));
    EXPECT_TRUE(probe.activeAt(2));
    EXPECT_GT(probe.poseAt(2).at.z, probe.radius);
    hands.clear();
    EXPECT_FALSE(probe.activeAt(2));
}

TEST(Hands, AreNoFasterThanImplicitStepsBear) {
    const double speed = sim::implicitToolSpeed(0.004, 1.0 / 60);
    EXPECT_DOUBLE_EQ(speed, 0.12);
    Hands hands(0.004, 0.2, 5000, speed);
    hands.begin(HandKind::probe, 0, {0, 0, 0}, {0, 0, 1});
    const glm::dvec3 from = hands.tools()[1].poseAt(0).at;
    hands.moveTo({50, 0, 0});
    hands.sample(1.0 / 60);
    EXPECT_NEAR(glm::distance(hands.tools()[1].poseAt(1.0 / 60).at, from), 0.002, 1e-12);
}

// A hand pulls the top of a block up and lets go: the block follows, and swings back.
TEST(Hands, PullABlock) {
    sim::LatticeRequest request;
    request.spacing = 0.01;
    const sim::TriangleMesh box = test::boxMesh({0, 0, 0}, {0.06, 0.06, 0.06});
    Result<sim::Lattice> lattice = sim::buildLattice(box, request);
    ASSERT_TRUE(lattice.ok());
    sim::SolverSetup setup;
    setup.lattice = &*lattice;
    setup.tissue.young = 3000;
    setup.tissue.dampingTime = 2e-3;
    constexpr double kFrame = 1.0 / 60;
    const sim::StableStep step = sim::stableStep(*lattice, setup.tissue, kFrame);
    setup.timeStep = step.timeStep;
    setup.fixed.assign(lattice->nodeCount(), false);
    std::size_t top = 0;
    for (std::size_t node = 0; node < lattice->nodeCount(); ++node) {
        setup.fixed[node] = lattice->nodes[node].y == 0;
        const glm::dvec3 rest = lattice->toWorld(lattice->restPosition(node));
        if (glm::distance(rest, glm::dvec3(0.03, 0.06, 0.03)) < 0.005)
            top = node;
    }
    Hands hands(0.01, glm::length(glm::dvec3(0.06)), 3000);
    setup.tools = hands.tools();
    const auto solver = sim::makeReferenceSolver(setup);
    const auto height = [&] { return lattice->toWorld(solver->state().positions[top]).y; };
    hands.begin(HandKind::grasp, 0, {0.03, 0.06, 0.03}, {0, 1, 0});
    for (int frame = 1; frame <= 12; ++frame) {
        hands.moveTo({0.03, 0.06 + 0.001 * frame, 0.03});
        hands.sample(frame * kFrame);
        solver->advance(step.stepsPerFrame);
        EXPECT_NEAR(height(), 0.06 + 0.001 * frame, 1e-6);
    }
    const double pull = -solver->takeLoads()[0].impulse.y;
    EXPECT_LT(pull, 0) << "the hand pulls up";
    hands.end(12 * kFrame);
    solver->advance(30 * step.stepsPerFrame);
    EXPECT_LT(height(), 0.065);
    EXPECT_EQ(solver->takeLoads()[1].impulse, glm::dvec3(0)) << "the finger rests";
}

} // namespace
} // namespace serosa::app
