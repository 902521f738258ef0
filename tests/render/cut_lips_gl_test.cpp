// Lips of a cut that is bent hard: with every mapping they lie where their side's cells have them, and what a
// cut changes fades for the copies of vertices, too.
#include "render/cut_surface.h"
#include "render/mapping_measures.h"
#include "render/picture_target.h"
#include "render/surface_passes.h"
#include "shaders/shared_constants.h"
#include "sim/blade.h"
#include "sim/pieces.h"
#include "sim/solver.h"
#include "tests/render/ball_fixture.h"

#include <algorithm>
#include <cmath>

namespace serosa::render {
namespace {

constexpr double kSpacing = 0.004; // m
constexpr double kPlane = 0.3;     // of the cut: x, lattice units from the middle of the ball
constexpr double kRadius = 3.3;    // spacings, of the bend: 90 degrees at the top of the ball

class GlCutLips : public test::GlBallTest {
protected:
    void SetUp() override {
        test::GlBallTest::SetUp();
        if (HasFatalFailure())
            return;
        makeBall(40, kSpacing);
        if (HasFatalFailure())
            return;
        target_.emplace(8, 8); // a context without a window cannot draw without one
        target_->bind();
        for (const sim::Mapping mapping : sim::kSurfaceMappings)
            bindings_.push_back(bindSurface(lattice_, mesh_, mapping));
        auto passes = SurfacePasses::create(lattice_, mesh_, bindings_, state_->layout());
        ASSERT_TRUE(passes.ok()) << passes.error().message;
        passes_.emplace(std::move(passes).value());
        ASSERT_TRUE(passes_->openMask(lattice_, state_->layout()).ok());
        connections_ = lattice_.connections;
    }
    void TearDown() override {
        passes_.reset();
        target_.reset();
        test::GlBallTest::TearDown();
    }

    /// A blade from above to a little below the middle, with the organ as it lies.
    /// \param cells false: as if each mapping carried all of its vertices alone
    void cut(const std::function<glm::dvec3(const glm::dvec3&)>& place, bool cells = true) {
        const sim::LatticeState now = deformedState(lattice_, place);
        state_->upload(now);
        sim::Stroke stroke;
        for (const int end : {0, 1}) {
            stroke.from[std::size_t(end)] = lattice_.toWorld(middle_ + glm::dvec3(kPlane, 8, end ? 8 : -8));
            stroke.to[std::size_t(end)] = lattice_.toWorld(middle_ + glm::dvec3(kPlane, -0.4, end ? 8 : -8));
        }
        passes_->mask()->paint(*state_, lattice_, stroke);
        connections_ = lattice_.connections;
        sim::cutConnections(lattice_, now.positions, sim::toLattice(stroke, lattice_), connections_);
        std::vector<SurfaceBinding> rebound;
        for (const SurfaceBinding& binding : bindings_)
            rebound.push_back(expressBinding(binding, lattice_, mesh_, binding.mapping, connections_));
        surface_ =
            cutSurface(lattice_, mesh_, bindings_[0], rebound[0], connections_, passes_->mask()->nodeSides());
        if (!cells) {
            std::fill(surface_.shares.begin(), surface_.shares.end(), 0.0F);
            for (CutVertex& vertex : surface_.vertices)
                vertex.share = 0;
        }
        const Status shown = passes_->show(surface_, lattice_, mesh_, rebound,
                                           sim::boundaryLeft(lattice_, connections_), state_->layout());
        ASSERT_TRUE(shown.ok()) << shown.error().message;
    }

    void show(const std::function<glm::dvec3(const glm::dvec3&)>& move) {
        sim::LatticeState now = deformedState(lattice_, move);
        now.connections = connections_;
        state_->upload(now);
    }

    struct Vertex {
        glm::vec3 position, normal;
    };
    static std::vector<Vertex> read(const gpu::Buffer& buffer) {
        std::vector<Vertex> vertices(buffer.bytes() / sizeof(Vertex));
        buffer.download(0, buffer.bytes(), vertices.data());
        return vertices;
    }
    std::vector<Vertex> drawn(sim::Mapping mapping) {
        return read(passes_->shown(*state_, stageOf(mapping)));
    }
    std::vector<Vertex> copies(sim::Mapping mapping) {
        const std::vector<Vertex> all = drawn(mapping);
        return {all.end() - std::ptrdiff_t(passes_->copies().size()), all.end()};
    }
    glm::dvec3 rest(std::size_t copy) const {
        return lattice_.toLattice(mesh_.positions[passes_->copies()[copy].vertex]);
    }
    /// Of the cut, by the rest place of what lies on it.
    double across(const glm::dvec3& q) const { return q.x - middle_.x - kPlane; }

    /// A half that curls to the left from the middle upwards.
    glm::dvec3 curl(const glm::dvec3& q) const {
        const glm::dvec3 p = q - middle_ - glm::dvec3(kPlane, 0, 0);
        if (p.y < 0)
            return q;
        const double angle = p.y / kRadius;
        return middle_ + glm::dvec3(kPlane - kRadius + (kRadius + p.x) * std::cos(angle),
                                    (kRadius + p.x) * std::sin(angle), p.z);
    }
    /// The side, 1 or -1, that the mask counts the left half as.
    int leftSide() const {
        const std::vector<float> sides = passes_->mask()->nodeSides();
        for (std::size_t node = 0; node < sides.size(); ++node)
            if (across(lattice_.restPosition(node)) < 0 && std::abs(sides[node]) < 1)
                return sides[node] < 0 ? -1 : 1;
        return 0;
    }
    glm::dvec3 bent(const glm::dvec3& q) const { return middle_ + bend(q - middle_, {}, 9); }

    std::vector<SurfaceBinding> bindings_;
    std::optional<PictureTarget> target_;
    std::optional<SurfacePasses> passes_;
    std::vector<std::uint32_t> connections_;
    CutSurface surface_;
};

TEST_F(GlCutLips, LieInTheCellsOfTheirSideWhateverTheMapping) {
    for (const bool inCells : {false, true}) {
        passes_->mask()->clear();
        cut([](const glm::dvec3& q) { return q; }, inCells);
        show([&](const glm::dvec3& q) { return across(q) < 0 ? curl(q) : q; });
        const int left = leftSide();
        ASSERT_NE(left, 0);
        const std::vector<Vertex> cells = copies(sim::Mapping::trilinear);
        for (const sim::Mapping mapping : sim::kSurfaceMappings) {
            SCOPED_TRACE(int(mapping));
            const std::vector<Vertex> carried = copies(mapping);
            ASSERT_EQ(carried.size(), cells.size());
            double fromCells = 0, fromCurl = 0, turned = 0; // h, h, 1
            int lips = 0;
            for (std::size_t i = 0; i < carried.size(); ++i) {
                const glm::dvec3 place = rest(i), now(carried[i].position);
                if (std::abs(across(place)) > 0.3 || place.y < middle_.y + 1)
                    continue;
                ++lips;
                fromCells = std::max(fromCells, glm::distance(now, glm::dvec3(cells[i].position)));
                turned = std::max(turned, double(glm::distance(carried[i].normal, cells[i].normal)));
                const bool curls = passes_->copies()[i].side == left;
                fromCurl = std::max(fromCurl, glm::distance(now, curls ? curl(place) : place));
            }
            EXPECT_GT(lips, 100);
            if (inCells) {
                EXPECT_LT(fromCells, 1e-4);
                EXPECT_LT(turned, 1e-3);
                EXPECT_LT(fromCurl, 0.2);
            } else if (mapping != sim::Mapping::trilinear) {
                EXPECT_GT(fromCells, 0.5) << "else this test shows nothing";
            }
            RecordProperty((inCells ? "from_curl_" : "from_curl_alone_") + std::to_string(int(mapping)),
                           std::to_string(fromCurl));
        }
    }
}

TEST_F(GlCutLips, TheMappingTakesOverWithoutAStep) {
    cut([](const glm::dvec3& q) { return q; });
    ASSERT_EQ(surface_.shares.size(), mesh_.positions.size());
    double least = 1, most = 0, steepest = 0;
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
        const glm::dvec3 q = lattice_.toLattice(mesh_.positions[v]) - middle_;
        if (std::abs(q.x - kPlane) < 0.7 && q.y > 0.5)
            least = std::min(least, double(surface_.shares[v]));
        if (std::abs(q.x - kPlane) > 4 || q.y < -4)
            most = std::max(most, double(surface_.shares[v]));
    }
    EXPECT_EQ(least, 1);
    EXPECT_EQ(most, 0);
    for (const glm::uvec3& face : mesh_.faces)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = face[i], b = face[(i + 1) % 3];
            steepest =
                std::max(steepest, std::abs(double(surface_.shares[a]) - double(surface_.shares[b])) /
                                       (glm::distance(mesh_.positions[a], mesh_.positions[b]) / kSpacing));
        }
    EXPECT_LT(steepest, 2.5) << "of the share, a spacing";
    // So a face whose corners are drawn as they are and a copy beside it share an edge.
    for (std::size_t i = 0; i < surface_.vertices.size(); ++i)
        EXPECT_GE(surface_.vertices[i].share, surface_.shares[surface_.vertices[i].vertex]);
}

// Cut in motion: no copy jumps from where its vertex was, and at rest it rests.
TEST_F(GlCutLips, CopiesFadeAndRestAgain) {
    const auto bent = [&](const glm::dvec3& q) { return this->bent(q); };
    for (const sim::Mapping mapping : sim::kSurfaceMappings) {
        SCOPED_TRACE(int(mapping));
        passes_->mask()->clear();
        const SurfaceStage stage = stageOf(mapping);
        show(bent);
        const gpu::Buffer before = passes_->shown(*state_, stage);
        const std::vector<SurfacePasses::Copy> copiesBefore = passes_->copies();
        cut(bent);
        if (HasFatalFailure())
            return;
        show(bent);
        const gpu::Buffer start = passes_->shownAfter(before, copiesBefore);
        ASSERT_TRUE(passes_->prepareBlend().ok());
        passes_->startBlend(*state_, stage, start, 1, glm::vec3(0), float(SRS_BLEND_STEP));
        const std::size_t fresh = passes_->copies().size();
        ASSERT_GT(fresh, 300U);
        std::vector<Vertex> last = read(start);
        double all = 0;
        for (int frame = 0; frame <= int(SRS_BLEND_MOST_FRAMES); frame += frame < 20 ? 1 : 230) {
            passes_->setBlendFrame(float(frame));
            const std::vector<Vertex> now = drawn(mapping);
            ASSERT_EQ(now.size(), last.size());
            double most = 0;
            for (std::size_t v = 0; v < now.size(); ++v)
                most = std::max(most, double(glm::distance(now[v].position, last[v].position)));
            EXPECT_LE(most, frame == 0 ? 1e-4 : 0.1) << "frame " << frame;
            all = std::max(all, most);
            last = now;
        }
        EXPECT_TRUE(mapping == sim::Mapping::trilinear || all > 1e-3) << "nothing faded";
        show([](const glm::dvec3& q) { return q; });
        const std::vector<Vertex> rested = copies(mapping);
        for (std::size_t i = 0; i < rested.size(); ++i)
            EXPECT_LT(glm::distance(glm::dvec3(rested[i].position), rest(i)), 2e-5);
        connections_ = lattice_.connections;
    }
}

} // namespace
} // namespace serosa::render
