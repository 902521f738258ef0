#pragma once
// A body under a probe, a grasp and cuts, and the promise of snapshots that all solvers keep.

#include "sim/snapshot.h"
#include "tests/sim/cut_strokes.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>

namespace serosa::test {

/// A hollow ball that is held at its bottom, pressed by a probe from the start, and held by a grasp from step
/// 30 to beyond step 200.
inline sim::SolverSetup handledBall(const sim::Lattice& lattice, double poisson = 0.25) {
    sim::SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue.poisson = poisson;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
    setup.gravity = {0, -9.81, 0};
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(node.y <= 1);
    const double second = 200 * setup.timeStep, h = lattice.spacing;
    sim::Tool probe;
    probe.name = "probe";
    probe.radius = 2 * h;
    probe.keys = {{0, lattice.toWorld({0, 6.5, 0})}, {second, lattice.toWorld({0, 4.5, 0})}};
    sim::Tool grasp;
    grasp.name = "grasp";
    grasp.mode = sim::ToolMode::grasp;
    grasp.radius = 1.6 * h;
    grasp.keys = {{0.15 * second, lattice.toWorld({4, 0, 0})}, {2 * second, lattice.toWorld({6, 1, 0})}};
    setup.tools = {probe, grasp};
    return setup;
}

/// From step `from` to step 200, with a stroke in three parts at 60, one at 80, 120 and 150.
inline void handle(sim::Solver& solver, sim::CutList& cuts, int from, int to,
                   std::vector<glm::dvec3>* impulses = nullptr) {
    for (int step = from; step < to; step += 10) {
        std::mt19937 random{unsigned(step)};
        if (step == 60 || step == 80 || step == 120 || step == 150) {
            for (int part = 0; part < (step == 60 ? 3 : 1); ++part) {
                sim::Stroke stroke = randomStroke(solver.lattice(), random, 0.4);
                stroke.continues = part > 0;
                ASSERT_TRUE(cuts.cut(solver, step, stroke).ok());
            }
        }
        solver.advance(10);
        for (const glm::dvec3& impulse : solver.takeToolImpulses())
            if (impulses)
                impulses->push_back(impulse);
    }
}

/// Saves at step 100 through the bytes of a file, and goes on in a fresh solver: what follows must be the
/// same bytes as without a stop, and so must undoing every stroke.
inline void
expectSameBytesAfterARestore(const std::function<std::unique_ptr<sim::Solver>(const sim::SolverSetup&)>& make,
                             double poisson = 0.25) {
    const sim::Lattice lattice = hollowBall();
    const sim::SolverSetup setup = handledBall(lattice, poisson);
    const auto whole = make(setup);
    whole->setState(sim::startState(setup));
    sim::CutList cuts;
    std::vector<std::string> before{whole->state().hash()};
    handle(*whole, cuts, 0, 100);

    sim::Snapshot taken;
    taken.program = "1.2.3";
    taken.frame = 10;
    taken.frameRate = 60;
    taken.organs.resize(1);
    sim::OrganSnapshot& organ = taken.organs.front();
    organ.name = "ball";
    organ.traits = sim::setupTraits(setup);
    organ.cuts = cuts.entries();
    sim::takeSnapshot(*whole, organ);
    EXPECT_EQ(organ.layers.size(), 2u);
    EXPECT_GT(std::count_if(organ.state.heldBy.begin(), organ.state.heldBy.end(),
                            [](std::uint32_t tool) { return tool == 2; }),
              3);
    const std::string atSave = whole->state().hash();
    EXPECT_EQ(organ.state.hash(), atSave) << "taking a snapshot changes nothing";

    const auto read = sim::parseSnapshot(sim::snapshotBytes(taken), "file");
    ASSERT_TRUE(read) << read.error().message;
    const sim::OrganSnapshot& saved = read->organs.front();
    const auto rest = make(setup);
    ASSERT_TRUE(sim::checkSnapshot(saved, "ball", rest->name(), sim::setupTraits(setup), lattice).ok());
    rest->advance(7); // what it did before must not matter
    ASSERT_TRUE(rest->cut(fullCut(lattice, 0.3)).ok());
    ASSERT_TRUE(sim::restoreSnapshot(saved, *rest).ok());
    sim::CutList restCuts;
    restCuts.assign(saved.cuts);
    EXPECT_EQ(rest->state().hash(), atSave);
    EXPECT_EQ(rest->cutLayers(), organ.layers);

    std::vector<glm::dvec3> impulses, restImpulses;
    handle(*whole, cuts, 100, 200, &impulses);
    handle(*rest, restCuts, 100, 200, &restImpulses);
    const sim::LatticeState a = whole->state(), b = rest->state();
    EXPECT_EQ(a.hash(), b.hash());
    EXPECT_NE(a.hash(), atSave);
    EXPECT_EQ(a.step, 200);
    EXPECT_EQ(b.step, 200);
    EXPECT_EQ(a.positions, b.positions); // of the reference all 64 bits
    EXPECT_EQ(a.increments, b.increments);
    EXPECT_EQ(a.connections, b.connections);
    EXPECT_EQ(impulses, restImpulses);
    EXPECT_TRUE(std::any_of(impulses.begin(), impulses.end(), [](const glm::dvec3& impulse) {
        return glm::length(impulse) > 0;
    })) << "the tools touch";

    // Strokes from before and after the stop are undone alike, down to the first connections.
    EXPECT_EQ(restCuts.strokes(), 4u);
    for (int strokes = 4; strokes > 0; --strokes) {
        EXPECT_FALSE(rest->state().connections.empty());
        ASSERT_TRUE(cuts.undo(*whole));
        ASSERT_TRUE(restCuts.undo(*rest));
        EXPECT_EQ(whole->state().hash(), rest->state().hash()) << strokes;
        EXPECT_EQ(restCuts.strokes(), std::size_t(strokes - 1));
    }
    EXPECT_FALSE(restCuts.undo(*rest));
    EXPECT_TRUE(rest->state().connections.empty());
    rest->setState(sim::startState(setup));
    EXPECT_EQ(rest->state().hash(), before.front());
}

} // namespace serosa::test
