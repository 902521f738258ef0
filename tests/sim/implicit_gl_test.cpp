// The implicit step in compute passes, against the same in float32 on the processor and against the oracle in
// double; on both layouts.
#include "shaders/shared_constants.h"
#include "sim/implicit_solver.h"
#include "tests/gl_fixture.h"
#include "tests/sim/implicit_bodies.h"
#include "tests/sim/materials.h"

#include <gtest/gtest.h>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

namespace {

class GlImplicit : public test::GlTest {};

std::unique_ptr<sim::Solver> onGpu(const SolverSetup& setup, int layout = -1,
                                   const sim::ImplicitLimits& limits = sim::frameLimits()) {
    return sim::makeImplicitTextureSolver(setup, "compute", layout, limits).value();
}

/// A ragged block of three materials, held at one side, and cut.
struct Handled {
    Lattice lattice = test::patchedLattice(21, 4);
    SolverSetup setup;
    sim::Stroke stroke;

    explicit Handled(const sim::Tissue& tissue) {
        setup = test::implicitSetup(lattice, 1000);
        setup.tissue = tissue;
        setup.gravity = {0, -9.81, 0};
        test::fixWhere(setup, [](const glm::ivec3& node) { return node.x == 0; });
        stroke.from = {lattice.toWorld({-0.6, 6, -6}), lattice.toWorld({-0.6, 6, 6})};
        stroke.to = {lattice.toWorld({-0.6, 0.3, -6}), lattice.toWorld({-0.6, 0.3, 6})};
    }
    Handled(const Handled&) = delete;
    Handled& operator=(const Handled&) = delete;

    /// One step and three times ten, the last ones cut.
    std::vector<LatticeState> run(sim::Solver& solver) const {
        std::vector<LatticeState> states;
        solver.setState(sim::startState(setup));
        for (int part = 0; part < 4; ++part) {
            solver.advance(part == 0 ? 1 : 10);
            if (part == 2) {
                EXPECT_TRUE(solver.cut(stroke).ok());
            }
            states.push_back(solver.state());
        }
        return states;
    }
};

sim::Tissue stiffMaterials() {
    sim::Tissue tissue = test::threeMaterials();
    tissue.others[1].young = 1e6;
    tissue.others[1].fibreYoung = 2e6;
    return tissue;
}

} // namespace

TEST_F(GlImplicit, aStepIsTheProcessorsOnBothLayouts) {
    const Lattice lattice = test::capsuleLattice(12);
    const SolverSetup setup = test::capsuleSetup(lattice);
    const auto cpu = sim::makeImplicitCpuSolver(setup), oracle = sim::makeImplicitReferenceSolver(setup);
    for (const auto& solver : {cpu.get(), oracle.get()})
        solver->setState(sim::startState(setup));
    std::vector<std::unique_ptr<sim::Solver>> gpu;
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS}) {
        gpu.push_back(onGpu(setup, layout));
        gpu.back()->setState(sim::startState(setup));
    }
    for (int frame = 0; frame < 12; ++frame) {
        cpu->advance(1);
        oracle->advance(1);
        for (const auto& solver : gpu)
            solver->advance(1);
        const LatticeState expected = cpu->state(), exact = oracle->state(), found = gpu[0]->state();
        EXPECT_LT(test::largestDistance(found, expected), 1e-4) << frame;
        EXPECT_LT(test::largestDistance(found, exact), 2e-3) << frame;
        EXPECT_EQ(found.hash(), gpu[1]->state().hash()) << "layouts change no byte";
    }
}

TEST_F(GlImplicit, handlesAllThatMaterialsCanBe) {
    sim::Tissue recovering, toe = test::threeMaterials(), fibres = test::threeMaterials();
    recovering.recovery = true;
    toe.recovery = false;
    toe.others.resize(1);
    sim::Tissue pressed;
    pressed.poisson = 0.45;
    for (const sim::Tissue& of : {recovering, pressed, toe, fibres, stiffMaterials()}) {
        sim::Tissue tissue = of;
        if (tissue.others.empty())
            tissue.others.assign(2, static_cast<const sim::Material&>(tissue));
        if (tissue.others.size() == 1)
            tissue.others.push_back(tissue.others[0]);
        const Handled body(tissue);
        const auto cpu = sim::makeImplicitCpuSolver(body.setup), gpu = onGpu(body.setup);
        const std::vector<LatticeState> found = body.run(*gpu), expected = body.run(*cpu);
        EXPECT_FALSE(found.back().connections.empty());
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_LT(test::largestDistance(found[i], expected[i]), 0.02) << i;
    }
}
