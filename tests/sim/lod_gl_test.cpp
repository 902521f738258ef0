// Level of detail in passes against its twin in double, on solvers in motion; momentum, detail, equal bytes.
#include "shaders/shared_constants.h"
#include "sim/lod_pass.h"
#include "sim/packed_normal.h"
#include "tests/gl_fixture.h"
#include "tests/sim/lod_shapes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace serosa;
using sim::LatticeState;

namespace {

class GlLod : public test::GlTest {
protected:
    /// Two neighbouring levels of a dented ball, from level `level` on, and their solvers.
    void make(std::size_t level, bool fixed, int layout, bool compute = false) {
        sim::SolverSetup plain;
        plain.tissue.young = 3000;
        plain.tissue.dampingTime = 0.0002;
        plain.gravity = {0, -9.81, 0};
        levels_.emplace(test::dentedBall(0.05), 0.006, plain);
        if (fixed)
            levels_->fixBelow(1.07);
        fine_ = &levels_->setups[level];
        coarse_ = &levels_->setups[level + 1];
        for (sim::SolverSetup* setup : {fine_, coarse_}) {
            if (compute) {
                sim::ComputeOptions options;
                options.layout = layout;
                solvers_.push_back(sim::makeComputeSolver(*setup, options).value());
            } else {
                sim::FragmentOptions options;
                options.layout = layout;
                solvers_.push_back(sim::makeFragmentSolver(*setup, options).value());
            }
        }
        pass_.emplace(sim::LodPass::create(*fine_, solvers_[0]->textures()->layout(), *coarse_,
                                           solvers_[1]->textures()->layout())
                          .value());
    }
    /// A turning, wobbling start, so that strains and velocities are large.
    static LatticeState wobbling(const sim::SolverSetup& setup) {
        LatticeState state = sim::restState(*setup.lattice);
        for (std::size_t i = 0; i < state.positions.size(); ++i) {
            if (!setup.fixed.empty() && setup.fixed[i])
                continue;
            glm::dvec3& x = state.positions[i];
            const glm::dvec3 v =
                glm::cross(glm::dvec3(5, 9, -7), x) + 6.0 * glm::sin(0.5 * glm::dvec3(x.z, x.x, x.y));
            x = glm::vec3(x + 0.4 * glm::cos(0.4 * glm::dvec3(x.y, x.z, x.x)));
            state.increments[i] = glm::vec3(setup.timeStep * v);
        }
        return state;
    }
    /// What the twin makes of the source's state, and the state that the pass made.
    std::pair<LatticeState, LatticeState> handOver(std::size_t from, std::size_t to, int steps) {
        const sim::SolverSetup &source = from == 0 ? *fine_ : *coarse_, &target = to == 0 ? *fine_ : *coarse_;
        solvers_[from]->advance(steps - 1);
        const std::vector<glm::dvec3> before = solvers_[from]->state().increments;
        solvers_[from]->advance(1);
        const LatticeState state = solvers_[from]->state();
        const auto transfer = sim::LodTransfer::make(source, target);
        const double lead = sim::lodLead(source.timeStep, target.timeStep);
        const LatticeState expected = sim::transferState(transfer, *target.lattice, state, before, lead, 11,
                                                         to == 0 ? pass_->detail() : sim::LodDetail());
        sim::StateTextures* textures = solvers_[to]->replaceState(11);
        to == 0 ? pass_->toFiner(*solvers_[from]->textures(), *textures, lead)
                : pass_->toCoarser(*solvers_[from]->textures(), *textures, lead);
        return {expected, solvers_[to]->state()};
    }
    static void expectEqual(const LatticeState& expected, const LatticeState& found) {
        ASSERT_EQ(expected.positions.size(), found.positions.size());
        EXPECT_EQ(found.step, expected.step);
        EXPECT_EQ(found.heldBy, expected.heldBy);
        EXPECT_TRUE(found.connections.empty());
        double off = 0, offVelocity = 0, fastest = 0, least = 1;
        for (std::size_t i = 0; i < found.positions.size(); ++i) {
            off = std::max(off, glm::distance(found.positions[i], expected.positions[i]));
            offVelocity = std::max(offVelocity, glm::distance(found.increments[i], expected.increments[i]));
            fastest = std::max(fastest, glm::length(expected.increments[i]));
            least = std::min(least, double(glm::dot(sim::unpackNormal(found.normals[i]),
                                                    sim::unpackNormal(expected.normals[i]))));
        }
        EXPECT_LT(off, 2e-5);
        EXPECT_LT(offVelocity, 2e-5 * fastest + 1e-7);
        EXPECT_GT(fastest, 1e-3);
        EXPECT_GT(least, 0.99); // nodes inside have no normal to speak of: checked loosely
    }

    std::optional<test::Levels> levels_;
    sim::SolverSetup *fine_ = nullptr, *coarse_ = nullptr;
    std::vector<std::unique_ptr<sim::Solver>> solvers_;
    std::optional<sim::LodPass> pass_;
};

double apart(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::distance(a, b) / glm::length(b);
}

} // namespace

TEST_F(GlLod, doesWhatTheTwinDoes) {
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS})
        for (const bool fixed : {false, true}) {
            solvers_.clear();
            make(fixed == (layout == SRS_LAYOUT_GRID) ? 0 : 1, fixed, layout, fixed);
            solvers_[0]->setState(wobbling(*fine_));
            const auto down = handOver(0, 1, 20);
            expectEqual(down.first, down.second);
            EXPECT_FALSE(pass_->detail().empty());
            const auto up = handOver(1, 0, 10);
            expectEqual(up.first, up.second);
            EXPECT_TRUE(pass_->detail().empty());
        }
}

TEST_F(GlLod, switchesKeepMomentum) {
    make(0, false, -1);
    solvers_[0]->setState(wobbling(*fine_));
    for (int i = 0; i < 6; ++i) {
        const std::size_t from = std::size_t(i % 2), to = 1 - from;
        const sim::SolverSetup &source = from == 0 ? *fine_ : *coarse_, &target = to == 0 ? *fine_ : *coarse_;
        solvers_[from]->advance(15);
        LatticeState state = solvers_[from]->state();
        sim::StateTextures* textures = solvers_[to]->replaceState(0);
        to == 0 ? pass_->toFiner(*solvers_[from]->textures(), *textures, 0)
                : pass_->toCoarser(*solvers_[from]->textures(), *textures, 0);
        const sim::Momentum before = sim::momentumOf(source, state),
                            after = sim::momentumOf(target, solvers_[to]->state());
        EXPECT_LT(apart(after.linear, before.linear), 1e-5) << i;
        EXPECT_LT(apart(after.angular, before.angular), 1e-5) << i;
    }
}

TEST_F(GlLod, theFineShapeComesBack) {
    make(0, true, -1);
    solvers_[0]->setState(wobbling(*fine_));
    solvers_[0]->advance(3); // before any cell is crushed
    const LatticeState before = solvers_[0]->state();
    pass_->toCoarser(*solvers_[0]->textures(), *solvers_[1]->replaceState(0), 0);
    const sim::LodDetail kept = pass_->detail();
    const LatticeState coarse = solvers_[1]->state();
    pass_->toFiner(*solvers_[1]->textures(), *solvers_[0]->replaceState(0), 0);
    const LatticeState after = solvers_[0]->state();
    for (std::size_t i = 0; i < before.positions.size(); ++i)
        ASSERT_LT(glm::distance(after.positions[i], before.positions[i]), 2e-5);
    // Kept elsewhere and set again, as a snapshot does: the same bytes.
    pass_->setDetail(kept);
    solvers_[1]->setState(coarse);
    pass_->toFiner(*solvers_[1]->textures(), *solvers_[0]->replaceState(0), 0);
    EXPECT_EQ(solvers_[0]->state().hash(), after.hash());
}

TEST_F(GlLod, restStaysAtRest) {
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS}) {
        solvers_.clear();
        make(0, false, layout);
        pass_->toCoarser(*solvers_[0]->textures(), *solvers_[1]->replaceState(0), 0);
        EXPECT_EQ(solvers_[1]->state().hash(), sim::restState(*coarse_->lattice).hash());
        pass_->toFiner(*solvers_[1]->textures(), *solvers_[0]->replaceState(0), 0);
        EXPECT_EQ(solvers_[0]->state().hash(), sim::restState(*fine_->lattice).hash());
    }
}
