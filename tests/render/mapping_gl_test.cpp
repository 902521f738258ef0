// The vertex stage through transform feedback: what holds on the GPU, and that a fault shows.
#include "render/mapping_measures.h"
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
    for (const auto mapping : {sim::Mapping::triangle, sim::Mapping::curvature}) {
        const auto errors = measureMapping(shape.lattice, shape.mesh, mapping, kMotions);
        ASSERT_TRUE(errors.ok()) << errors.error().message;
        EXPECT_LE(errors.value().rest, 1e-6);
        EXPECT_LE(errors.value().stretch, 1e-6);
        EXPECT_LE(errors.value().twin, 1e-6);
        EXPECT_LE(errors.value().normal, 5e-4);
        if (mapping == sim::Mapping::triangle) {
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

} // namespace
} // namespace serosa::render
