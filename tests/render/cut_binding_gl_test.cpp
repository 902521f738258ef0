// After a cut the surface is bound anew: nothing jumps, and rest is exact again.
#include "render/mapping_measures.h"
#include "render/surface_renderer.h"
#include "shaders/shared_constants.h"
#include "sim/packed_normal.h"
#include "sim/solver.h"
#include "tests/render/ball_fixture.h"

#include <algorithm>

namespace serosa::render {
namespace {

constexpr double kSpacing = 0.004, kRadius = 5.2 * kSpacing; // m

class GlCutBinding : public test::GlBallTest {
protected:
    void SetUp() override {
        test::GlBallTest::SetUp();
        if (HasFatalFailure())
            return;
        makeBall(24, kSpacing);
        if (HasFatalFailure())
            return;
        // A blade from above to the middle, between two layers of nodes.
        connections_ = lattice_.connections;
        for (std::size_t node = 0; node < lattice_.nodeCount(); ++node)
            for (std::size_t d = 0; d < sim::kNeighbourOffsets.size(); ++d) {
                const glm::ivec3 here = lattice_.nodes[node], there = here + sim::kNeighbourOffsets[d];
                if ((here.x <= 6) != (there.x <= 6) && here.y + there.y > 12)
                    connections_[node] &= ~(1U << d);
            }
    }

    SurfaceRenderer renderer(const SurfaceBinding& binding, const sim::StateTextures& state) {
        auto made = SurfaceRenderer::create(lattice_, mesh_, binding, state, 8, 8);
        EXPECT_TRUE(made.ok()) << made.error().message;
        return std::move(made).value();
    }

    /// Nodes that follow `move`, with eq. 3 over what connections are left.
    sim::LatticeState stateOf(const std::function<glm::dvec3(const glm::dvec3&)>& move,
                              const std::vector<std::uint32_t>& connections) const {
        sim::LatticeState state = deformedState(lattice_, move);
        for (std::size_t node = 0; node < lattice_.nodeCount(); ++node) {
            glm::dvec3 sum(0);
            for (int d = 0; d < 18; ++d)
                if ((connections[node] >> d) & 1U)
                    sum += glm::normalize(state.positions[node] -
                                          state.positions[std::size_t(lattice_.neighbour(node, d))]);
            state.normals[node] = sim::packNormal(glm::vec3(sum));
        }
        state.connections = connections;
        return state;
    }

    /// Largest distance, lattice units.
    static double apart(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
        double largest = 0;
        for (std::size_t v = 0; v < a.size(); ++v)
            largest = std::max(largest, glm::distance(a[v], b[v]) / kSpacing);
        return largest;
    }

    static glm::dvec3 bent(const glm::dvec3& q) { return bend(q, {}, 7); }
    static glm::dvec3 still(const glm::dvec3& q) { return q; }

    std::vector<std::uint32_t> connections_;
};

TEST_F(GlCutBinding, MovesNoVertexFarAFrameAndRestsAgain) {
    double mostLeft = 0;
    for (const sim::Mapping mapping : sim::kSurfaceMappings) {
        SCOPED_TRACE(int(mapping));
        auto state = sim::StateTextures::create(lattice_, {});
        ASSERT_TRUE(state.ok());
        const SurfaceBinding binding = bindSurface(lattice_, mesh_, mapping);
        SurfaceRenderer drawn = renderer(binding, state.value());
        // Cut in motion. The solver writes normals with its next step: until then they are those of before.
        state.value().upload(stateOf(bent, lattice_.connections));
        std::vector<glm::dvec3> last = drawn.readDeformedPositions(state.value(), mapping);
        const Status shown =
            drawn.showCuts(0, lattice_, mesh_, binding, state.value(), connections_, mapping, true);
        ASSERT_TRUE(shown.ok()) << shown.error().message;
        EXPECT_LE(apart(drawn.readDeformedPositions(state.value(), mapping), last), 1e-5);
        state.value().upload(stateOf(bent, connections_));
        int frames = 0;
        for (double moved = 1; moved > 0 && frames < 30; ++frames) {
            drawn.setBlendFrame(0, frames);
            const std::vector<glm::dvec3> now = drawn.readDeformedPositions(state.value(), mapping);
            moved = frames == 0 ? 1 : apart(now, last);
            EXPECT_LE(apart(now, last), 0.1) << "frame " << frames;
            mostLeft = std::max(mostLeft, apart(now, last));
            last = now;
        }
        EXPECT_LE(frames, 20);
        drawn.setBlendFrame(0, int(SRS_BLEND_MOST_FRAMES));
        state.value().upload(stateOf(still, connections_));
        EXPECT_LE(apart(drawn.readDeformedPositions(state.value(), mapping), mesh_.positions), 2e-5);
    }
    EXPECT_GT(mostLeft, 1e-3) << "nothing was bound anew";
}

TEST_F(GlCutBinding, UndoneItIsDrawnAsBefore) {
    for (const sim::Mapping mapping : {sim::Mapping::curvature, sim::Mapping::nodeFrames}) {
        auto state = sim::StateTextures::create(lattice_, {});
        ASSERT_TRUE(state.ok());
        const SurfaceBinding binding = bindSurface(lattice_, mesh_, mapping);
        SurfaceRenderer drawn = renderer(binding, state.value());
        state.value().upload(stateOf(bent, lattice_.connections));
        const auto before = drawn.readDeformedPositions(state.value(), mapping);
        ASSERT_TRUE(
            drawn.showCuts(0, lattice_, mesh_, binding, state.value(), connections_, mapping, false).ok());
        EXPECT_GT(apart(drawn.readDeformedPositions(state.value(), mapping), before), 1e-3);
        ASSERT_TRUE(
            drawn.showCuts(0, lattice_, mesh_, binding, state.value(), lattice_.connections, mapping, false)
                .ok());
        EXPECT_EQ(drawn.readDeformedPositions(state.value(), mapping), before);
    }
}

} // namespace
} // namespace serosa::render
