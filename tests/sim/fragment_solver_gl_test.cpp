// The fragment solver against its CPU twin, node by node, on both layouts and with every option.
#include "shaders/shared_constants.h"
#include "sim/packed_normal.h"
#include "sim/solver.h"
#include "sim/state_textures.h"
#include "tests/gl_fixture.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <random>

using namespace serosa;
using sim::FragmentOptions;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

namespace {

class GlFragmentSolver : public test::GlTest {};

/// A hollow, partly filled body with fixed nodes, gravity, damping, a probe and forceps.
struct Case {
    Lattice lattice;
    SolverSetup setup;
    Case() {
        std::vector<sim::LatticeCell> cells;
        std::mt19937 random(5);
        for (int z = 0; z < 9; ++z)
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 10; ++x) {
                    const double r =
                        glm::length((glm::dvec3(x, y, z) - glm::dvec3(4.5, 3.5, 4)) / glm::dvec3(5, 4, 4.5));
                    if (r < 1 && r > 0.45)
                        cells.push_back({{x, y, z}, std::uint8_t(60 + random() % 196)});
                }
        lattice = sim::latticeFromCells(cells, 0.003, {0.1, 1.6, -0.2});
        setup.lattice = &lattice;
        setup.gravity = {0, -9.81, 0};
        setup.tissue.airDrag = 2;
        setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(node.y == 0);
        const double t = setup.timeStep;
        const glm::dvec3 top = lattice.toWorld(glm::dvec3(0.3, 4, 0.2)),
                         side = lattice.toWorld(glm::dvec3(4.6, 0.2, 0.1));
        setup.tools = {
            {"probe", sim::ToolMode::push, 0.004, {{0, top + glm::dvec3(0, 0.006, 0)}, {60 * t, top}}},
            {"forceps",
             sim::ToolMode::grasp,
             0.004,
             {{20 * t, side}, {50 * t, side + glm::dvec3(0.005, 0, 0)}}}};
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;
};

double largestDifference(const LatticeState& a, const LatticeState& b) {
    double worst = 0;
    for (std::size_t node = 0; node < a.positions.size(); ++node)
        worst = std::max(worst, glm::length(a.positions[node] - b.positions[node]));
    return worst;
}

} // namespace

TEST_F(GlFragmentSolver, followsTheReferenceWithEveryOption) {
    const Case c;
    const auto reference = sim::makeReferenceSolver(c.setup);
    reference->advance(70);
    const LatticeState expected = reference->state();
    const std::vector<glm::dvec3> impulses = reference->takeToolImpulses();
    EXPECT_GT(largestDifference(expected, sim::restState(c.lattice)), 0.5);
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS})
        for (const bool printed : {true, false})
            for (const bool fetch : {true, false}) {
                FragmentOptions options;
                options.layout = layout;
                options.printedForm = printed;
                options.useTexelFetch = fetch;
                const auto solver = sim::makeFragmentSolver(c.setup, options).value();
                solver->advance(70);
                const LatticeState got = solver->state();
                EXPECT_LT(largestDifference(got, expected), 1e-3) << layout << printed << fetch;
                EXPECT_EQ(got.step, 70);
                for (std::size_t node = 0; node < got.normals.size(); ++node) {
                    const glm::vec3 a = sim::unpackNormal(got.normals[node]),
                                    b = sim::unpackNormal(expected.normals[node]);
                    if (glm::length(sim::restNormalSums(c.lattice)[node]) < 0.5)
                        continue;
                    ASSERT_GT(glm::dot(a, b), 0.9999f) << node;
                    if (node > 60)
                        break; // restNormalSums is not free
                }
                const std::vector<glm::dvec3> gotImpulses = solver->takeToolImpulses();
                for (std::size_t tool = 0; tool < 2; ++tool)
                    EXPECT_LT(glm::length(gotImpulses[tool] - impulses[tool]),
                              2e-3 * glm::length(impulses[tool]))
                        << tool;
                EXPECT_EQ(solver->takeToolImpulses()[0], glm::dvec3(0));
            }
}

TEST_F(GlFragmentSolver, heldNodesAreTheSame) {
    const Case c;
    const auto reference = sim::makeReferenceSolver(c.setup);
    const auto solver = sim::makeFragmentSolver(c.setup).value();
    for (const int steps : {19, 2, 20, 15}) {
        reference->advance(steps);
        solver->advance(steps);
        EXPECT_EQ(solver->state().heldBy, reference->state().heldBy)
            << "after step " << reference->state().step;
    }
}

TEST_F(GlFragmentSolver, normalsCanBeLeftOut) {
    const Case c;
    FragmentOptions options;
    options.normals = false;
    const auto plain = sim::makeFragmentSolver(c.setup, options).value();
    const auto full = sim::makeFragmentSolver(c.setup).value();
    plain->advance(10);
    full->advance(10);
    EXPECT_EQ(plain->state().positions, full->state().positions);
    EXPECT_NE(plain->state().normals, full->state().normals);
}

TEST_F(GlFragmentSolver, normalsOfTheLastStepAreWrittenHoweverStepsAreGrouped) {
    const Case c;
    FragmentOptions everyStep;
    everyStep.normalsEveryStep = true;
    const auto every = sim::makeFragmentSolver(c.setup, everyStep).value();
    const auto together = sim::makeFragmentSolver(c.setup).value();
    const auto alone = sim::makeFragmentSolver(c.setup).value();
    every->advance(12);
    together->advance(12);
    for (int step = 0; step < 12; ++step)
        alone->advance(1);
    EXPECT_NE(every->state().normals, sim::restState(c.lattice).normals) << "they do turn";
    EXPECT_EQ(together->state().hash(), every->state().hash());
    EXPECT_EQ(alone->state().hash(), every->state().hash());
}

TEST_F(GlFragmentSolver, continuesFromAStateWithTheSameBytes) {
    const Case c;
    const auto straight = sim::makeFragmentSolver(c.setup).value();
    straight->advance(60);
    const auto first = sim::makeFragmentSolver(c.setup).value();
    first->advance(31);
    const auto second = sim::makeFragmentSolver(c.setup).value();
    second->setState(first->state());
    second->advance(29);
    EXPECT_EQ(second->state().hash(), straight->state().hash());
}

TEST_F(GlFragmentSolver, uploadAndDownloadKeepEveryValue) {
    const Case c;
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS}) {
        sim::StateTextures textures = sim::StateTextures::create(c.lattice, c.setup.fixed, layout).value();
        LatticeState state = sim::restState(c.lattice);
        std::mt19937 random(9);
        for (std::size_t node = 0; node < c.lattice.nodeCount(); ++node) {
            state.positions[node] =
                glm::dvec3(glm::vec3(random() % 1000, random() % 1000, random() % 1000) * 0.01f);
            state.increments[node] = glm::dvec3(glm::vec3(random() % 1000) * 0.001f);
            state.normals[node] = sim::packNormal(glm::vec3(random() % 7, 1, -double(random() % 5)));
            state.heldBy[node] = random() % 5;
        }
        textures.upload(state);
        EXPECT_EQ(textures.download(0).hash(), state.hash());
        EXPECT_GT(textures.bytes(), c.lattice.nodeCount() * 96);
    }
}

TEST_F(GlFragmentSolver, refusesALayoutThatDoesNotFit) {
    // 1 x 140 x 140 cells: strips would need 19,881 rows.
    const Lattice plate = test::blockLattice(1, 140, 140);
    SolverSetup setup;
    setup.lattice = &plate;
    setup.timeStep = 1e-4;
    FragmentOptions options;
    options.layout = SRS_LAYOUT_GRID;
    const auto solver = sim::makeFragmentSolver(setup, options);
    ASSERT_FALSE(solver.ok());
    EXPECT_NE(solver.error().message.find("19881"), std::string::npos) << solver.error().message;
}

TEST_F(GlFragmentSolver, volumetricTermFollowsTheReference) {
    for (const bool recovery : {false, true}) {
        Case c;
        c.setup.tissue.poisson = recovery ? 0.25 : 0.45;
        c.setup.tissue.recovery = recovery;
        c.setup.tools.resize(1); // a blending target beside the pass's own
        c.setup.tools[0].radius = 0.008;
        c.setup.tools[0].keys[1].at.y -= 0.006;
        c.setup.timeStep = sim::stableStep(c.lattice, c.setup.tissue, 1.0 / 60).timeStep;
        c.setup.tools[0].keys[1].time = 60 * c.setup.timeStep;
        const auto reference = sim::makeReferenceSolver(c.setup);
        reference->advance(70);
        const LatticeState expected = reference->state();
        SolverSetup plainSetup = c.setup;
        plainSetup.tissue.poisson = 0.25;
        plainSetup.tissue.recovery = false;
        const auto plain = sim::makeReferenceSolver(plainSetup);
        plain->advance(70);
        EXPECT_GT(largestDifference(expected, plain->state()), 0.01) << "the term acts";
        const glm::dvec3 impulse = reference->takeToolImpulses()[0];
        for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS})
            for (const bool fetch : {true, false}) {
                FragmentOptions options;
                options.layout = layout;
                options.useTexelFetch = fetch;
                const auto solver = sim::makeFragmentSolver(c.setup, options).value();
                solver->advance(70);
                EXPECT_LT(largestDifference(solver->state(), expected), 1e-3) << layout << fetch << recovery;
                EXPECT_LT(glm::length(solver->takeToolImpulses()[0] - impulse), 2e-3 * glm::length(impulse));
            }
    }
}

TEST_F(GlFragmentSolver, nearlyIncompressibleTissueStaysExactlyAtRest) {
    Case c;
    c.setup.tissue.poisson = 0.49;
    c.setup.tissue.recovery = true;
    c.setup.gravity = {0, 0, 0};
    c.setup.tools.clear();
    const auto solver = sim::makeFragmentSolver(c.setup).value();
    solver->advance(100);
    EXPECT_EQ(largestDifference(solver->state(), sim::restState(c.lattice)), 0);
}
