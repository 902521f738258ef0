// What is packed into a vertex, and what the packing costs.
#include "render/mapping_measures.h"
#include "render/surface_vertices.h"
#include "sim/solver.h"
#include "tests/render/shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace serosa::render {
namespace {

constexpr double kSpacing = 0.004;  // m
constexpr double kRestError = 1e-6; // of the size: what `serosa verify mapping` allows

struct Bound {
    sim::Lattice lattice;
    sim::TriangleMesh mesh;
    SurfaceBinding binding;
    double size; // lattice units
};

Bound ball(sim::Mapping mapping) {
    Bound bound{test::ballLattice(6.3, kSpacing, {}), {}, {}, 12.6};
    bound.mesh =
        test::ballMesh(24, 6.3 * kSpacing, bound.lattice.toWorld(glm::dvec3(7 - bound.lattice.centre)));
    bound.binding = bindSurface(bound.lattice, bound.mesh, mapping);
    return bound;
}

double restError(const Bound& bound, const SurfaceBinding& binding) {
    const sim::LatticeState rest = sim::restState(bound.lattice);
    const auto mapped = mapSurface(binding, rest.positions, rest.normals);
    double largest = 0;
    for (std::size_t v = 0; v < mapped.size(); ++v)
        largest =
            std::max(largest, glm::distance(mapped[v], bound.lattice.toLattice(bound.mesh.positions[v])));
    return largest / bound.size;
}

float inSteps(double value, double range, double steps) {
    return float(std::round(value / range * steps) / steps * range);
}

TEST(SurfaceVertices, SixteenBitsAreEnoughForWeightsAndNotForOffsets) {
    for (const auto mapping : {sim::Mapping::triangle, sim::Mapping::curvature, sim::Mapping::nodeFrames}) {
        const Bound bound = ball(mapping);
        for (const VertexBinding& vertex : bound.binding.vertices) // 16 bits, and the offset makes up for it
            for (int i = 0; i < 2; ++i)
                ASSERT_EQ(vertex.weights[i], inSteps(vertex.weights[i], 1, 65535));
        EXPECT_LE(restError(bound, bound.binding), 0.1 * kRestError);
        SurfaceBinding coarse = bound.binding;
        for (VertexBinding& vertex : coarse.vertices)
            for (int i = 0; i < 3; ++i)
                vertex.offset[i] = inSteps(vertex.offset[i], 2, 32767);
        EXPECT_GT(restError(bound, coarse), kRestError) << "16 bits would do: pack them";
    }
}

TEST(SurfaceVertices, WeightsAlongTheNormalNeedMoreThanSixteenBits) {
    const Bound bound = ball(sim::Mapping::normalOffset);
    EXPECT_LE(restError(bound, bound.binding), 0.1 * kRestError);
    SurfaceBinding coarse = bound.binding; // nothing makes up for what their rounding misses
    for (NormalOffset& along : coarse.alongNormal)
        for (int i = 0; i < 2; ++i)
            along.weights[i] = inSteps(along.weights[i], 1, 65535);
    EXPECT_GT(restError(bound, coarse), kRestError) << "16 bits would do: pack them";
}

TEST(SurfaceVertices, BytesAreThoseOfTheMapping) {
    EXPECT_EQ(ball(sim::Mapping::triangle).binding.bytesPerVertex, 36);
    EXPECT_EQ(ball(sim::Mapping::nodeFrames).binding.bytesPerVertex, 36);
    EXPECT_EQ(ball(sim::Mapping::chosen).binding.bytesPerVertex, 40);
    EXPECT_EQ(ball(sim::Mapping::normalOffset).binding.bytesPerVertex, 32);
    EXPECT_EQ(ball(sim::Mapping::trilinear).binding.bytesPerVertex, 24);
}

TEST(SurfaceVertices, CellTexelsFillWholeRows) {
    const Bound bound = ball(sim::Mapping::trilinear);
    auto layout = sim::makeTextureLayout(bound.lattice, -1, 16384);
    ASSERT_TRUE(layout.ok());
    const auto texels = cellTexels(bound.binding.cells, layout.value());
    EXPECT_EQ(texels.size() % 4096, 0U);
    for (std::size_t cell = 0; cell < bound.binding.cells.corners.size(); ++cell)
        for (std::size_t c = 0; c < 8; ++c) {
            const glm::uvec2 at = layout.value().texelOfNode[bound.binding.cells.corners[cell][c]];
            ASSERT_EQ(texels[2 * cell + c / 4][int(c % 4)], at.y << 16 | at.x);
        }
}

} // namespace
} // namespace serosa::render
