// Tools that a hand moves: their samples are poses, the same as keys with the same places; and copies of a
// setup follow them.

#include "sim/live_tool.h"
#include "sim/solver.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <memory>

namespace serosa::sim {
namespace {

TEST(LiveTool, InterpolatesAndSwitchesAtItsSamples) {
    LiveTool live;
    EXPECT_FALSE(live.activeAt(0));
    live.add({1, {0, 0, 0}, {1, 0, 0, 0}, true});
    live.add({2, {4, 0, 0}, glm::angleAxis(1.0, glm::dvec3(0, 0, 1)) * 3.0, true});
    live.add({3, {9, 9, 9}, {1, 0, 0, 0}, true});
    live.add({3, {4, 8, 0}, {1, 0, 0, 0}, false}); // instead
    EXPECT_EQ(live.samples().size(), 3u);
    EXPECT_EQ(live.poseAt(0).at, glm::dvec3(0));
    EXPECT_EQ(live.poseAt(1.25).at, glm::dvec3(1, 0, 0));
    EXPECT_NEAR(glm::angle(live.poseAt(1.5).turn), 0.5, 1e-12) << "normalized, and half of the way";
    EXPECT_EQ(live.poseAt(2.5).at, glm::dvec3(4, 4, 0));
    EXPECT_EQ(live.poseAt(7).at, glm::dvec3(4, 8, 0));
    EXPECT_FALSE(live.activeAt(0.99));
    EXPECT_TRUE(live.activeAt(1));
    EXPECT_TRUE(live.activeAt(2.99));
    EXPECT_FALSE(live.activeAt(3));
    live.clear();
    EXPECT_FALSE(live.activeAt(2));
}

class LiveToolSteps : public ::testing::Test {
protected:
    static constexpr int kFrames = 12, kStepsAFrame = 8;
    static constexpr double kFrame = 1.0 / 60;

    LiveToolSteps() : lattice_(buildCube()) {
        setup_.lattice = &lattice_;
        setup_.timeStep = kFrame / kStepsAFrame;
        setup_.tissue.dampingTime = 1e-4;
        setup_.fixed.assign(lattice_.nodeCount(), false);
        for (std::size_t node = 0; node < lattice_.nodeCount(); ++node)
            setup_.fixed[node] = lattice_.nodes[node].y == 0;
    }
    static Lattice buildCube() {
        LatticeRequest request;
        request.spacing = 0.01;
        Result<Lattice> lattice = buildLattice(test::boxMesh({0, 0, 0}, {0.06, 0.06, 0.06}), request);
        EXPECT_TRUE(lattice.ok());
        return std::move(*lattice);
    }
    Lattice lattice_;
    SolverSetup setup_;
};

// A grasp by samples that are added frame by frame, and the same places as keys.
TEST_F(LiveToolSteps, AreThoseOfTheSameKeys) {
    Tool scripted;
    scripted.mode = ToolMode::grasp;
    scripted.radius = 0.015;
    const auto place = [](int frame) { return glm::dvec3(0.03, 0.06 + 0.002 * frame, 0.03); };
    for (int frame = 2; frame <= 9; ++frame)
        scripted.keys.push_back({frame * kFrame, place(frame)});
    SolverSetup byKeys = setup_;
    byKeys.tools = {scripted};
    const auto expected = makeReferenceSolver(byKeys);

    auto samples = std::make_shared<LiveTool>();
    Tool live = scripted;
    live.keys.clear();
    live.live = samples;
    SolverSetup byHand = setup_;
    byHand.tools = {live};
    const auto solver = makeReferenceSolver(byHand);
    samples->add({2 * kFrame, place(2), {1, 0, 0, 0}, true});
    for (int frame = 0; frame < kFrames; ++frame) {
        if (frame >= 2 && frame < 9)
            samples->add({(frame + 1) * kFrame, place(frame + 1), {1, 0, 0, 0}, frame + 1 < 9});
        solver->advance(kStepsAFrame);
        expected->advance(kStepsAFrame);
        ASSERT_EQ(solver->state().hash(), expected->state().hash()) << "after frame " << frame + 1;
    }
    EXPECT_NE(solver->state().hash(), startState(setup_).hash());
}

TEST_F(LiveToolSteps, APushThatRestsIsNotThere) {
    auto samples = std::make_shared<LiveTool>();
    Tool live;
    live.radius = 0.01;
    live.live = samples;
    setup_.tools = {live};
    const auto solver = makeReferenceSolver(setup_);
    setup_.tools.clear();
    const auto alone = makeReferenceSolver(setup_);
    samples->add({0, {0.03, 0.06, 0.03}, {1, 0, 0, 0}, false}); // in the tissue
    for (const auto* each : {&solver, &alone})
        (*each)->advance(2 * kStepsAFrame);
    EXPECT_EQ(solver->state().hash(), alone->state().hash());
    samples->add({2 * kFrame, {0.03, 0.06, 0.03}, {1, 0, 0, 0}, true});
    for (const auto* each : {&solver, &alone})
        (*each)->advance(kStepsAFrame);
    EXPECT_NE(solver->state().hash(), alone->state().hash());
}

} // namespace
} // namespace serosa::sim
