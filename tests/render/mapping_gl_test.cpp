// The vertex stage through transform feedback: what holds on the GPU, and that a fault shows.
#include "render/frame_pass.h"
#include "render/mapping_measures.h"
#include "shaders/shared_constants.h"
#include "sim/packed_normal.h"
#include "tests/gl_fixture.h"
#include "tests/render/shapes.h"

namespace serosa::render {
namespace {

class GlMapping : public test::GlTest {};

constexpr double kSpacing = 0.004; // m
constexpr int kMotions = 4;

struct Shape {
    sim::Lattice lattice;
    sim::TriangleMesh mesh;
};

Shape ball() {
    Shape shape{test::ballLattice(6.3, kSpacing, {0.1, 1.6, -0.4}), {}};
    shape.mesh =
        test::ballMesh(24, 6.3 * kSpacing, shape.lattice.toWorld(glm::dvec3(7 - shape.lattice.centre)));
    return shape;
}

TEST_F(GlMapping, HoldsWhatIsKnown) {
    const Shape shape = ball();
    for (const auto mapping : sim::kSurfaceMappings) {
        SCOPED_TRACE(int(mapping));
        const auto errors = measureMapping(shape.lattice, shape.mesh, mapping, kMotions);
        ASSERT_TRUE(errors.ok()) << errors.error().message;
        EXPECT_LE(errors.value().rest, 1e-6);
        EXPECT_LE(errors.value().stretch, 1e-6);
        EXPECT_LE(errors.value().twin, 1e-6);
        EXPECT_LE(errors.value().normal, 5e-4);
        if (mapping == sim::Mapping::triangle || mapping == sim::Mapping::trilinear ||
            mapping == sim::Mapping::nodeFrames) { // which read no normals of 30 bits
            EXPECT_LE(errors.value().rigid, 1e-5);
        }
        EXPECT_LE(errors.value().rigidBeyond, 3e-4);
    }
}

TEST_F(GlMapping, StaleNormalsShow) {
    const Shape shape = ball();
    const auto errors =
        measureMapping(shape.lattice, shape.mesh, sim::Mapping::curvature, 1, NodeNormals::stale);
    ASSERT_TRUE(errors.ok());
    EXPECT_GT(errors.value().rigidBeyond, 0.1);
    EXPECT_LE(errors.value().twin, 1e-6); // both sides of the twin see the same fault
    const auto constant =
        measureMapping(shape.lattice, shape.mesh, sim::Mapping::triangle, 1, NodeNormals::stale);
    ASSERT_TRUE(constant.ok());
    EXPECT_LE(constant.value().rigid, 1e-5); // which reads no node normal
}

TEST_F(GlMapping, CorrectionClosesTheBendsGaps) {
    const auto constant = measureBendGaps(sim::Mapping::triangle, 0.5);
    const auto corrected = measureBendGaps(sim::Mapping::curvature, 0.5);
    ASSERT_TRUE(constant.ok() && corrected.ok());
    EXPECT_EQ(constant.value().edges, 48U); // 16 faces of 4 cells, 32 triangles
    EXPECT_GT(constant.value().largest, 0.05);
    EXPECT_LE(corrected.value().largest, 0.6 * constant.value().largest);
    const auto stale = measureBendGaps(sim::Mapping::curvature, 0.5, NodeNormals::stale);
    ASSERT_TRUE(stale.ok());
    EXPECT_NE(stale.value().largest, corrected.value().largest);
}

TEST_F(GlMapping, NodeFramesCloseTheBendsGaps) {
    for (const double height : {0.25, 1.0}) {
        const auto frames = measureBendGaps(sim::Mapping::nodeFrames, height);
        ASSERT_TRUE(frames.ok());
        EXPECT_EQ(frames.value().edges, 48U);
        EXPECT_LE(frames.value().largest, 1e-5);
    }
}

/// Frames of the boundary's nodes as the pass writes them.
TEST_F(GlMapping, FramesOfThePassAreThoseOfTheTwin) {
    const Shape shape = ball();
    for (const int layout : {SRS_LAYOUT_GRID, SRS_LAYOUT_ROWS}) {
        auto state = sim::StateTextures::create(shape.lattice, {}, layout);
        ASSERT_TRUE(state.ok());
        const FrameStencil stencil = frameStencil(shape.lattice);
        auto pass = FramePass::create(stencil, state.value().layout());
        ASSERT_TRUE(pass.ok()) << pass.error().message;
        const sim::LatticeState bent = deformedState(shape.lattice, [](const glm::dvec3& q) {
            return bend(1.3 * q, {1, 2, 3}, 9) + glm::dvec3(5, -4, 7);
        });
        state.value().upload(bent);
        pass.value().run(state.value().positions());
        std::vector<glm::uvec2> texels(state.value().layout().texels());
        pass.value().frames().download(texels.data(), texels.size() * sizeof texels[0]);
        const std::vector<glm::uvec2> twin = nodeFrames(stencil, bent.positions);
        double largest = 0;
        for (const FrameStencil::Row& row : stencil.rows) {
            const glm::uvec2 at = state.value().layout().texelOfNode[row.node];
            const glm::dquat
                a = unpackFrame(texels[std::size_t(at.y) * std::size_t(state.value().layout().width) + at.x]),
                b = unpackFrame(twin[row.node]);
            largest = std::max(largest, 1 - std::abs(glm::dot(a, b)));
        }
        EXPECT_LE(largest, 1e-11); // 1 - cos(angle / 2): 1e-5 rad
    }
}

} // namespace
} // namespace serosa::render
