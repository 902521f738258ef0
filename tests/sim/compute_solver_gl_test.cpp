// The compute solver against the fragment solver (the same kernel: the same bytes on software GL) and against
// the reference, on both layouts, with and without tiles, whatever the work group's size.
#include "shaders/shared_constants.h"
#include "sim/blade.h"
#include "sim/solver.h"
#include "sim/state_textures.h"
#include "tests/gl_fixture.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace serosa;
using sim::ComputeOptions;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

namespace {

class GlComputeSolver : public test::GlTest {
protected:
    /// Two stages compile the same kernel to the same arithmetic on software GL; a GPU's compiler need not.
    static bool sameArithmetic() { return test::sharedTestContext()->info().software; }
};

enum class Thin { shell, sheet };

/// Thin organs, partly filled, with fixed nodes, gravity, damping, a probe and forceps. No size of theirs is
/// a multiple of a work group's.
struct Case {
    Lattice lattice;
    SolverSetup setup;
    explicit Case(Thin shape = Thin::shell) {
        std::vector<sim::LatticeCell> cells;
        std::mt19937 random(5);
        const glm::ivec3 size = shape == Thin::shell ? glm::ivec3(10, 8, 9) : glm::ivec3(13, 1, 11);
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const double r =
                        glm::length((glm::dvec3(x, y, z) - glm::dvec3(4.5, 3.5, 4)) / glm::dvec3(5, 4, 4.5));
                    if (shape == Thin::sheet || (r < 1 && r > 0.72))
                        cells.push_back({{x, y, z}, std::uint8_t(60 + random() % 196)});
                }
        lattice = sim::latticeFromCells(cells, 0.003, {0.1, 1.6, -0.2});
        setup.lattice = &lattice;
        setup.gravity = {0, -9.81, 0};
        setup.tissue.airDrag = 2;
        setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(shape == Thin::shell ? node.y == 0 : node.x == 0 || node.x == size.x);
        const double t = setup.timeStep, up = shape == Thin::shell ? 4 : 0.4;
        const glm::dvec3 top = lattice.toWorld(glm::dvec3(0.3, up, 0.2)),
                         side = lattice.toWorld(glm::dvec3(shape == Thin::shell ? 4.6 : 2.6, 0.2, 0.1));
        setup.tools = {
            {"probe", sim::ToolMode::push, 0.004, {{0, top + glm::dvec3(0, 0.006, 0)}, {260 * t, top}}},
            {"forceps",
             sim::ToolMode::grasp,
             0.004,
             {{20 * t, side}, {220 * t, side + glm::dvec3(0.005, 0.002, 0)}}}};
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

/// Both layouts, the grid's with and without tiles.
std::vector<ComputeOptions> variants() {
    std::vector<ComputeOptions> list(3);
    list[0].layout = SRS_LAYOUT_ROWS;
    list[1].layout = list[2].layout = SRS_LAYOUT_GRID;
    list[2].tiles = true;
    return list;
}

} // namespace

TEST_F(GlComputeSolver, agreesWithReferenceAndFragmentOnThinOrgans) {
    for (const Thin shape : {Thin::shell, Thin::sheet}) {
        const Case c(shape);
        const auto reference = sim::makeReferenceSolver(c.setup);
        reference->advance(300);
        const LatticeState expected = reference->state();
        const std::vector<glm::dvec3> impulses = reference->takeToolImpulses();
        EXPECT_GT(largestDifference(expected, sim::restState(c.lattice)), 0.5);
        const auto fragment = sim::makeFragmentSolver(c.setup).value();
        fragment->advance(300);
        const std::string fragmentHash = fragment->state().hash();
        const std::vector<glm::dvec3> fragmentImpulses = fragment->takeToolImpulses();
        for (const ComputeOptions& options : variants()) {
            const auto solver = sim::makeComputeSolver(c.setup, options).value();
            EXPECT_STREQ(solver->name(), "compute");
            solver->advance(300);
            const LatticeState got = solver->state();
            EXPECT_EQ(got.step, 300);
            EXPECT_LT(largestDifference(got, expected), 1e-3);
            if (sameArithmetic()) {
                EXPECT_EQ(got.hash(), fragmentHash) << options.layout << options.tiles;
            }
            const std::vector<glm::dvec3> gotImpulses = solver->takeToolImpulses();
            ASSERT_EQ(gotImpulses.size(), 2u);
            for (std::size_t tool = 0; tool < 2; ++tool) {
                EXPECT_GT(glm::length(impulses[tool]), 0);
                EXPECT_LT(glm::length(gotImpulses[tool] - impulses[tool]),
                          2e-3 * glm::length(impulses[tool]));
                EXPECT_LT(glm::length(gotImpulses[tool] - fragmentImpulses[tool]),
                          1e-6 * glm::length(fragmentImpulses[tool]))
                    << tool;
                EXPECT_EQ(solver->takeToolImpulses()[tool], glm::dvec3(0)) << "taken once";
            }
        }
    }
}

TEST_F(GlComputeSolver, normalsOfTheLastStepAreWrittenHoweverStepsAreGrouped) {
    const Case c;
    for (ComputeOptions options : variants()) {
        const auto together = sim::makeComputeSolver(c.setup, options).value();
        options.normalsEveryStep = true;
        const auto every = sim::makeComputeSolver(c.setup, options).value();
        together->advance(12);
        every->advance(12);
        EXPECT_EQ(together->state().hash(), every->state().hash()) << options.layout << options.tiles;
    }
}

TEST_F(GlComputeSolver, repeatsByteForByte) {
    const Case c;
    for (const ComputeOptions& options : variants()) {
        std::string hashes[2];
        std::vector<glm::dvec3> impulses[2];
        for (int run = 0; run < 2; ++run) {
            const auto solver = sim::makeComputeSolver(c.setup, options).value();
            for (int frame = 0; frame < 10; ++frame) {
                solver->advance(15);
                for (const glm::dvec3& impulse : solver->takeToolImpulses())
                    impulses[run].push_back(impulse);
            }
            hashes[run] = solver->state().hash();
        }
        EXPECT_EQ(hashes[0], hashes[1]);
        EXPECT_EQ(impulses[0], impulses[1]);
    }
}

TEST_F(GlComputeSolver, anyWorkGroupGivesTheSameBytes) {
    const Case c;
    const auto fragment = sim::makeFragmentSolver(c.setup).value();
    fragment->advance(120);
    const LatticeState expected = fragment->state();
    for (const glm::ivec2 group : {glm::ivec2(1, 1), glm::ivec2(7, 5), glm::ivec2(64, 2), glm::ivec2(128, 1)})
        for (const ComputeOptions& variant : variants()) {
            ComputeOptions options = variant;
            options.gridGroup = options.rowsGroup = group;
            options.tileGroup = glm::ivec3(group.x % 9 + 1, group.y, 3);
            const auto solver = sim::makeComputeSolver(c.setup, options).value();
            solver->advance(120);
            const LatticeState got = solver->state();
            EXPECT_LT(largestDifference(got, expected), 1e-4) << group.x;
            if (sameArithmetic()) {
                EXPECT_EQ(got.hash(), expected.hash()) << group.x << " " << options.tiles;
            }
        }
}

TEST_F(GlComputeSolver, everyKernelOptionFollowsTheReference) {
    const Case c;
    const auto reference = sim::makeReferenceSolver(c.setup);
    reference->advance(100);
    const LatticeState expected = reference->state();
    for (const ComputeOptions& variant : variants())
        for (const bool printed : {true, false})
            for (const bool fetch : {true, false}) {
                ComputeOptions options = variant;
                options.printedForm = printed;
                options.useTexelFetch = fetch;
                const auto solver = sim::makeComputeSolver(c.setup, options).value();
                solver->advance(100);
                EXPECT_LT(largestDifference(solver->state(), expected), 1e-3)
                    << options.layout << options.tiles << printed << fetch;
                EXPECT_EQ(solver->state().heldBy, expected.heldBy);
            }
}

TEST_F(GlComputeSolver, continuesFromAStateWithTheSameBytes) {
    const Case c;
    for (const ComputeOptions& options : variants()) {
        const auto straight = sim::makeComputeSolver(c.setup, options).value();
        straight->advance(150);
        const auto first = sim::makeComputeSolver(c.setup, options).value();
        first->advance(101);
        const auto second = sim::makeComputeSolver(c.setup, options).value();
        second->setState(first->state());
        EXPECT_TRUE(second->state().connections.empty()) << "nothing is cut";
        second->advance(49);
        EXPECT_EQ(second->state().hash(), straight->state().hash());
    }
}

TEST_F(GlComputeSolver, honoursTheConnectionsThatCutsLeft) {
    // A hanging bar whose springs across the middle are all gone: the lower half falls free.
    const Lattice bar = test::blockLattice(2, 8, 2);
    SolverSetup setup;
    setup.lattice = &bar;
    setup.gravity = {0, -9.81, 0};
    setup.tissue.dampingTime = 0;
    setup.timeStep = sim::stableStep(bar, setup.tissue, 1.0 / 60).timeStep;
    for (const glm::ivec3& node : bar.nodes)
        setup.fixed.push_back(node.y == 8);
    LatticeState cut = sim::restState(bar);
    cut.connections = bar.connections;
    for (std::size_t node = 0; node < bar.nodeCount(); ++node)
        for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
            const int from = bar.nodes[node].y, to = from + sim::kNeighbourOffsets[std::size_t(d)].y;
            if (std::min(from, to) == 3 && std::max(from, to) == 4)
                cut.connections[node] &= ~(1u << d);
        }
    for (const ComputeOptions& options : variants()) {
        const auto solver = sim::makeComputeSolver(setup, options).value();
        solver->setState(cut);
        solver->advance(50);
        const LatticeState after = solver->state();
        EXPECT_EQ(after.connections, cut.connections);
        // Increments from rest: after n steps the path is g dt^2 n (n + 1) / 2.
        const double path = 9.81 * setup.timeStep * setup.timeStep / bar.spacing * 50 * 51 / 2;
        for (std::size_t node = 0; node < bar.nodeCount(); ++node) {
            const double fell = bar.restPosition(node).y - after.positions[node].y;
            if (bar.nodes[node].y <= 3)
                EXPECT_NEAR(fell, path, 1e-5 * path + 1e-6) << node;
            else
                EXPECT_LT(fell, 0.5 * path) << node;
        }
        LatticeState mended = after;
        mended.connections.clear();
        solver->setState(mended);
        EXPECT_TRUE(solver->state().connections.empty()) << "as built again";
    }
}

TEST_F(GlComputeSolver, cutsInTheMiddleOfARunAsTheFragmentSolverDoes) {
    const Case c;
    sim::Stroke stroke; // down through the shell beside its middle
    const auto at = [&c](double y, double z) { return c.lattice.toWorld(glm::dvec3(1.3, y, z)); };
    stroke.from = {at(6, -7), at(6, 7)};
    stroke.to = {at(-1, -7), at(-1, 7)};
    const auto fragment = sim::makeFragmentSolver(c.setup).value();
    fragment->advance(60);
    ASSERT_TRUE(fragment->cut(stroke).ok());
    fragment->advance(60);
    const LatticeState expected = fragment->state();
    ASSERT_FALSE(expected.connections.empty()) << "the stroke must cut something";
    const auto solver = sim::makeComputeSolver(c.setup).value();
    solver->advance(60);
    ASSERT_TRUE(solver->cut(stroke).ok());
    solver->advance(60);
    const LatticeState got = solver->state();
    if (sameArithmetic()) {
        EXPECT_EQ(got.connections, expected.connections);
        EXPECT_EQ(got.hash(), expected.hash());
    }
    EXPECT_EQ(solver->pieces().value(), fragment->pieces().value());
    EXPECT_TRUE(solver->undoCut());
    EXPECT_TRUE(solver->state().connections.empty());
}

TEST_F(GlComputeSolver, refusesWhatDoesNotFit) {
    const Lattice plate = test::blockLattice(1, 140, 140);
    SolverSetup setup;
    setup.lattice = &plate;
    setup.timeStep = 1e-4;
    ComputeOptions options;
    options.layout = SRS_LAYOUT_GRID;
    const auto solver = sim::makeComputeSolver(setup, options);
    ASSERT_FALSE(solver.ok());
    EXPECT_NE(solver.error().message.find("19881"), std::string::npos) << solver.error().message;
}
