// Fewer samples for what is small on the screen or fast (CS07 section 6.3): none fewer at rest and at normal
// size, and silhouettes that stay within a pixel.
#include "render/raycast_measures.h"
#include "tests/render/ball_fixture.h"
#include "tests/render/ball_maps.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace serosa::render {
namespace {

constexpr double kRadius = 0.04; // m
constexpr int kSamples = 48;
constexpr int kNormal = 140; // pixels: a voxel is more than one
constexpr glm::dvec3 kDirection{0.3, -0.5, -0.8};

class GlRaycastCoarse : public test::GlBallTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        ball_ = test::ballMesh(24, kRadius, glm::dvec3(0));
        auto volume = DistanceVolume::create(
            ball_, VolumeGrid::around(ball_.lowest(), ball_.highest(), kSamples, 3), 0);
        ASSERT_TRUE(volume.ok()) << volume.error().message;
        volume_.emplace(std::move(*volume));
        auto texture = DeformationTexture::bake(ballMap(MapKind::pull), glm::ivec3(48), TexelFormat::half);
        ASSERT_TRUE(texture.ok()) << texture.error().message;
        texture_.emplace(std::move(*texture));
        space_ = objectSpace(kRadius / 15);
        auto caster = Raycaster::create(space_, *volume_);
        ASSERT_TRUE(caster.ok());
        caster_.emplace(std::move(*caster));
        caster_->setWarp(Warp{&*texture_, {}});
        look_.skipField = look_.skipCut = false; // every sample counts
    }
    void TearDown() override {
        caster_.reset();
        volume_.reset();
        GlBallTest::TearDown();
    }
    std::vector<RaycastProbe> show(int size, double coarse, sim::Projection projection) {
        look_.coarse = coarse;
        const RaycastView view = viewOf(size, projection);
        auto probes = caster_->probe(view.frame, look_, size, size);
        EXPECT_TRUE(probes.ok()) << (probes.ok() ? "" : probes.error().message);
        return *probes;
    }
    RaycastView viewOf(int size, sim::Projection projection) const {
        const glm::dvec3 half(kRadius);
        return RaycastView::of(space_, -half, half, kDirection, projection, size, size);
    }
    static double samples(const std::vector<RaycastProbe>& probes) {
        return std::accumulate(probes.begin(), probes.end(), 0.0,
                               [](double sum, const RaycastProbe& one) { return sum + one.samples; });
    }
    /// Pixels in which one shows something and the other does not, with no border of the other beside.
    static int beyondAPixel(const std::vector<RaycastProbe>& probes, const std::vector<RaycastProbe>& full,
                            int size) {
        int off = 0;
        for (int y = 1; y + 1 < size; ++y)
            for (int x = 1; x + 1 < size; ++x) {
                const bool shown = probes[std::size_t(y * size + x)].kind != 0;
                bool beside = false;
                for (int k = 0; k < 9; ++k)
                    beside = beside ||
                             (full[std::size_t((y + k / 3 - 1) * size + x + k % 3 - 1)].kind != 0) == shown;
                off += !beside;
            }
        return off;
    }

    sim::TriangleMesh ball_;
    sim::Lattice space_;
    std::optional<DistanceVolume> volume_;
    std::optional<DeformationTexture> texture_;
    std::optional<Raycaster> caster_;
    RaycastLook look_;
};

TEST_F(GlRaycastCoarse, ShowsTheSameAtRestAndAtNormalSize) {
    for (const auto projection : {sim::Projection::perspective, sim::Projection::orthographic}) {
        const auto full = show(kNormal, 0, projection), coarse = show(kNormal, 0.5, projection);
        ASSERT_GT(samples(full), 1e5);
        for (std::size_t i = 0; i < full.size(); ++i) {
            EXPECT_EQ(coarse[i].kind, full[i].kind);
            EXPECT_EQ(coarse[i].samples, full[i].samples);
            EXPECT_EQ(coarse[i].t, full[i].t);
        }
    }
}

TEST_F(GlRaycastCoarse, TakesFewerSamplesOfWhatIsSmall) {
    for (const auto projection : {sim::Projection::perspective, sim::Projection::orthographic}) {
        // A pixel is some three voxels wide, half of one three steps long.
        constexpr int kSmall = 24;
        const auto full = show(kSmall, 0, projection), coarse = show(kSmall, 0.5, projection);
        EXPECT_LT(samples(coarse), 0.45 * samples(full));
        EXPECT_GT(samples(coarse), 0.2 * samples(full));
        EXPECT_EQ(beyondAPixel(coarse, full, kSmall), 0);
        RaycastAgreement sum;
        addAgreement(sum, coarse, full, 0.25 * viewOf(kSmall, projection).footprint({}));
        EXPECT_GT(sum.object, 80);
        EXPECT_LE(sum.silhouettes, 0.03 * sum.object);
        EXPECT_LE(sum.deep, 0.03 * sum.both);
    }
}

TEST_F(GlRaycastCoarse, TakesFewerSamplesOfWhatMovesOnTheScreen) {
    constexpr int kSize = kNormal;
    const auto orthographic = sim::Projection::orthographic;
    const RaycastView view = viewOf(kSize, orthographic);
    const double pixel = view.footprint({});
    const glm::dvec3 away = view.ray(0).along, aside = glm::normalize(glm::cross(away, glm::dvec3(0, 1, 0)));
    const auto full = show(kSize, 0, orthographic);
    const auto moving = [&](const glm::dvec3& by) {
        caster_->setMotion(glm::translate(glm::dmat4(1), -by));
        return show(kSize, 0.5, orthographic);
    };
    const auto fast = moving(8 * pixel * aside), slow = moving(0.5 * pixel * aside),
               towards = moving(8 * pixel * away);
    EXPECT_LT(samples(fast), 0.5 * samples(full));
    EXPECT_EQ(beyondAPixel(fast, full, kSize), 0);
    EXPECT_EQ(samples(slow), samples(full));
    EXPECT_EQ(samples(towards), samples(full)) << "no way on the screen";
    // At rest again with the next place.
    caster_->setWarp(Warp{&*texture_, {}});
    EXPECT_EQ(samples(show(kSize, 0.5, orthographic)), samples(full));
}

// An organ of a lattice: as fast as its nodes go in a frame.
TEST_F(GlRaycastCoarse, TakesFewerSamplesOfALatticeThatMoves) {
    makeBall(12, 0.008);
    auto volume =
        DistanceVolume::create(mesh_, VolumeGrid::around(mesh_.lowest(), mesh_.highest(), kSamples, 3), 0);
    ASSERT_TRUE(volume.ok()) << volume.error().message;
    auto warp = LatticeWarp::create(lattice_, state_->layout());
    auto caster = Raycaster::create(lattice_, *volume);
    ASSERT_TRUE(warp.ok() && caster.ok());
    caster->setLattice(&*warp);
    constexpr int kSize = kNormal;
    const RaycastView view = RaycastView::of(lattice_, mesh_.lowest(), mesh_.highest(), kDirection,
                                             sim::Projection::perspective, kSize, kSize);
    sim::LatticeState state = sim::restState(lattice_);
    const auto shown = [&](double way, int steps, double coarse) { // spacings a step
        for (glm::dvec3& increment : state.increments)
            increment = glm::dvec3(0, way, 0);
        state_->upload(state);
        EXPECT_TRUE(warp->update(*state_, nullptr, steps).ok());
        RaycastLook look = look_;
        look.coarse = coarse;
        auto probes = caster->probe(view.frame, look, kSize, kSize);
        EXPECT_TRUE(probes.ok());
        return *probes;
    };
    const auto full = shown(0.1, 10, 0);
    ASSERT_GT(samples(full), 5e4);
    EXPECT_EQ(samples(shown(0, 10, 0.5)), samples(full));
    EXPECT_EQ(samples(shown(0.1, 0, 0.5)), samples(full)) << "it rests";
    const auto fast = shown(0.1, 10, 0.5);
    EXPECT_LT(samples(fast), 0.5 * samples(full));
    EXPECT_EQ(beyondAPixel(fast, full, kSize), 0);
}

} // namespace
} // namespace serosa::render
