// Several materials, stiffening, fibres and the volumetric term on the GPU: the fragment and the compute
// solver against the reference, on both layouts, with a probe, forceps and a cut.
#include "shaders/shared_constants.h"
#include "sim/solver.h"
#include "sim/tissue_field.h"
#include "tests/gl_fixture.h"
#include "tests/sim/materials.h"

#include <gtest/gtest.h>

#include <random>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

namespace {

class GlMaterials : public test::GlTest {};

/// A ragged block of three materials, held at one side, pushed, pulled and cut.
struct Case {
    Lattice lattice = test::patchedLattice(21, 7);
    SolverSetup setup;
    sim::Stroke stroke;

    explicit Case(const sim::Tissue& tissue) {
        setup.lattice = &lattice;
        setup.tissue = tissue;
        setup.gravity = {0, -9.81, 0};
        setup.timeStep = sim::stableStep(lattice, tissue, 1.0 / 60).timeStep;
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(node.x == 0);
        const double t = setup.timeStep;
        const glm::dvec3 top = lattice.toWorld({0, 4, 0}), side = lattice.toWorld({3, 0, 0});
        setup.tools = {{"probe",
                        sim::ToolMode::push,
                        0.005,
                        {{0, top + glm::dvec3(0, 0.008, 0)}, {150 * t, top}, {300 * t, top}}},
                       {"forceps",
                        sim::ToolMode::grasp,
                        0.004,
                        {{20 * t, side}, {250 * t, side + glm::dvec3(0.006, 0, 0)}}}};
        stroke.from = {lattice.toWorld({-0.6, 6, -6}), lattice.toWorld({-0.6, 6, 6})};
        stroke.to = {lattice.toWorld({-0.6, 0.3, -6}), lattice.toWorld({-0.6, 0.3, 6})};
    }
    Case(const Case&) = delete;
    Case& operator=(const Case&) = delete;

    /// 300 steps with the cut after 150.
    LatticeState run(sim::Solver& solver) const {
        solver.advance(150);
        EXPECT_TRUE(solver.cut(stroke).ok());
        solver.advance(150);
        return solver.state();
    }
};

/// All at once, and each that has shaders of its own by itself.
std::vector<std::pair<const char*, sim::Tissue>> tissues() {
    const sim::Tissue all = test::threeMaterials();
    std::vector<std::pair<const char*, sim::Tissue>> list = {{"all", all}};
    const auto plain = [&](const char* name, auto change) {
        sim::Tissue tissue = all;
        tissue.recovery = false;
        for (sim::Material& material : tissue.others) {
            material.poisson = tissue.poisson = 0.25;
            material.dampingTime = tissue.dampingTime;
            material.curve.clear();
            material.strainLimit = material.fibreYoung = 0;
        }
        change(tissue);
        list.emplace_back(name, tissue);
    };
    plain("stiffness and density", [](sim::Tissue&) {});
    plain("damping", [](sim::Tissue& tissue) { tissue.others[0].dampingTime = 0.0001; });
    plain("curves", [](sim::Tissue& tissue) { tissue.others[1].curve = {{0.02, 180}, {0.1, 2000}}; });
    plain("fibres", [](sim::Tissue& tissue) {
        tissue.others[0].fibreYoung = 8000;
        tissue.others[0].fibre = {1, 1, 0};
    });
    plain("Poisson's ratio", [](sim::Tissue& tissue) { tissue.others[1].poisson = 0.49; });
    return list;
}

double worst(const LatticeState& a, const LatticeState& b) {
    double largest = 0;
    for (std::size_t node = 0; node < a.positions.size(); ++node)
        if (const double apart = glm::distance(a.positions[node], b.positions[node]); !(apart <= largest))
            largest = apart; // what is no number stays
    return largest;
}

} // namespace

TEST_F(GlMaterials, agreeWithTheReference) {
    for (const auto& [name, tissue] : tissues()) {
        const Case scene(tissue);
        const auto reference = sim::makeReferenceSolver(scene.setup);
        const LatticeState expected = scene.run(*reference);
        double moved = 0;
        for (std::size_t node = 0; node < expected.positions.size(); ++node)
            moved =
                std::max(moved, glm::distance(expected.positions[node], scene.lattice.restPosition(node)));
        EXPECT_GT(moved, 0.5) << name;
        EXPECT_FALSE(expected.connections.empty()) << name;
        for (const int layout : {SRS_LAYOUT_ROWS, SRS_LAYOUT_GRID}) {
            sim::FragmentOptions fragmentOptions;
            fragmentOptions.layout = layout;
            const auto fragment = sim::makeFragmentSolver(scene.setup, fragmentOptions).value();
            const LatticeState got = scene.run(*fragment);
            EXPECT_EQ(got.connections, expected.connections) << name;
            EXPECT_LT(worst(got, expected), 1e-3) << name << " " << layout;
            for (const bool tiles : {false, true}) {
                sim::ComputeOptions options;
                options.layout = layout;
                options.tiles = tiles;
                const auto compute = sim::makeComputeSolver(scene.setup, options).value();
                const LatticeState same = scene.run(*compute);
                EXPECT_LT(worst(same, expected), 1e-3) << name << " " << layout << tiles;
                if (test::sharedTestContext()->info().software) {
                    EXPECT_EQ(same.hash(), got.hash()) << name << " " << layout << tiles;
                }
            }
        }
    }
}

// Cells squeezed, drawn out and inside out: all that the laws do at large strain.
TEST_F(GlMaterials, oneStepFromADisturbedStateIsTheReferences) {
    Case scene(test::threeMaterials());
    scene.setup.tools.clear();
    LatticeState state = sim::restState(scene.lattice);
    std::mt19937 random(8);
    const auto one = [&random] { return double(random()) / 2147483648.0 - 1; };
    for (std::size_t node = 0; node < state.positions.size(); ++node)
        for (int axis = 0; axis < 3; ++axis) {
            state.positions[node][axis] = float(state.positions[node][axis] + 0.5 * one());
            state.increments[node][axis] = float(0.05 * one());
        }
    const auto changeOf = [&state](sim::Solver& solver) {
        solver.setState(state);
        solver.advance(1);
        std::vector<glm::dvec3> change = solver.state().increments;
        for (std::size_t node = 0; node < change.size(); ++node)
            change[node] -= state.increments[node];
        return change;
    };
    const std::vector<glm::dvec3> expected = changeOf(*sim::makeReferenceSolver(scene.setup));
    double size = 0;
    for (const glm::dvec3& change : expected)
        size += glm::length(change) / double(expected.size());
    for (const bool compute : {false, true}) {
        const auto solver = compute ? sim::makeComputeSolver(scene.setup).value()
                                    : sim::makeFragmentSolver(scene.setup).value();
        const std::vector<glm::dvec3> got = changeOf(*solver);
        for (std::size_t node = 0; node < got.size(); ++node)
            EXPECT_LT(glm::length(got[node] - expected[node]), 1e-4 * size) << node << " " << compute;
    }
}

TEST_F(GlMaterials, pushOutSlowlyWhatLiesInside) {
    Case scene(test::threeMaterials());
    scene.setup.tools = {
        {"probe", sim::ToolMode::push, 0.004, {{0, scene.lattice.toWorld({0.3, 0.2, 0.1})}}}};
    const auto reference = sim::makeReferenceSolver(scene.setup);
    const auto fragment = sim::makeFragmentSolver(scene.setup).value();
    reference->advance(200);
    fragment->advance(200);
    EXPECT_LT(worst(fragment->state(), reference->state()), 1e-3);
    EXPECT_GT(worst(sim::restState(scene.lattice), reference->state()), 0.3);
}

TEST_F(GlMaterials, keepMomentumAndRest) {
    Case scene(test::threeMaterials());
    scene.setup.tools.clear();
    scene.setup.gravity = glm::dvec3(0);
    scene.setup.fixed.clear();
    const auto solver = sim::makeFragmentSolver(scene.setup).value();
    const LatticeState rest = sim::restState(scene.lattice);
    solver->setState(rest);
    solver->advance(500);
    EXPECT_EQ(solver->state().positions, rest.positions);

    LatticeState state = rest;
    std::mt19937 random(3);
    for (glm::dvec3& u : state.increments)
        for (int axis = 0; axis < 3; ++axis)
            u[axis] = 0.005 * (double(random()) / 2147483648.0 - 1);
    const sim::TissueField field(scene.lattice, scene.setup.tissue);
    glm::dvec3 drift(0);
    double size = 0;
    for (std::size_t node = 0; node < state.increments.size(); ++node) {
        drift -= field.massShare(node) * state.increments[node];
        size += field.massShare(node) * glm::length(state.increments[node]);
    }
    solver->setState(state);
    solver->advance(1000);
    const LatticeState after = solver->state();
    for (std::size_t node = 0; node < after.increments.size(); ++node)
        drift += field.massShare(node) * after.increments[node];
    EXPECT_LT(glm::length(drift), 1e-5 * size);
}
