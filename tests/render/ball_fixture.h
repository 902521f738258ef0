#pragma once
// A ball on a lattice in textures, metres away from the origin: what tests of drawing begin with.

#include "sim/state_textures.h"
#include "tests/gl_fixture.h"
#include "tests/render/shapes.h"

#include <optional>

namespace serosa::test {

class GlBallTest : public GlTest {
protected:
    static constexpr double kBallSpacings = 5.2; // its radius

    /// \param squares a face of ballMesh
    void makeBall(int squares, double spacing) {
        lattice_ = ballLattice(kBallSpacings, spacing, {0.1, 1.6, -0.4});
        middle_ = glm::dvec3(6 - lattice_.centre);
        centre_ = lattice_.toWorld(middle_);
        mesh_ = ballMesh(squares, kBallSpacings * spacing, centre_);
        auto state = sim::StateTextures::create(lattice_, {});
        ASSERT_TRUE(state.ok()) << state.error().message;
        state_.emplace(std::move(state).value());
    }
    void TearDown() override {
        state_.reset();
        GlTest::TearDown();
    }

    sim::Lattice lattice_;
    glm::dvec3 middle_{0}, centre_{0}; // of the ball: lattice units; m
    sim::TriangleMesh mesh_;
    std::optional<sim::StateTextures> state_;
};

} // namespace serosa::test
