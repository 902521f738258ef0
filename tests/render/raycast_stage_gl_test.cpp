// Two-stage drawing: mesh outside of a box, ray casting inside, one picture (render/stage_box.h).
#include "models/phantom.h"
#include "render/mapping_measures.h"
#include "render/raycaster.h"
#include "render/surface_renderer.h"
#include "tests/render/ball_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace serosa::render {
namespace {

constexpr int kSize = 160;
constexpr double kSpacing = 0.008, kRadius = 5.2 * kSpacing; // m

class GlRaycastStage : public test::GlBallTest {
protected:
    void SetUp() override {
        test::GlBallTest::SetUp();
        if (HasFatalFailure())
            return;
        makeBall(48, kSpacing);
        if (HasFatalFailure())
            return;
        binding_ = bindSurface(lattice_, mesh_, sim::Mapping::curvature);
        auto renderer = SurfaceRenderer::create(lattice_, mesh_, binding_, *state_, kSize, kSize);
        ASSERT_TRUE(renderer.ok()) << renderer.error().message;
        renderer_.emplace(std::move(renderer).value());
        auto volume =
            DistanceVolume::create(mesh_, VolumeGrid::around(mesh_.lowest(), mesh_.highest(), 64, 3), 0);
        ASSERT_TRUE(volume.ok());
        volume_.emplace(std::move(volume).value());
        auto caster = Raycaster::create(lattice_, *volume_);
        ASSERT_TRUE(caster.ok());
        caster_.emplace(std::move(caster).value());
        sim::Camera camera;
        camera.direction = {-0.3, -0.4, -1};
        view_.camera = makeCamera(camera, mesh_.lowest(), mesh_.highest(), 1);
        view_.casters = {&*caster_};
    }
    void TearDown() override {
        caster_.reset();
        volume_.reset();
        renderer_.reset();
        test::GlBallTest::TearDown();
    }
    Image draw(sim::Show show, sim::Stage stage = sim::Stage::whole) {
        view_.look.show = show;
        view_.look.stage = stage;
        renderer_->draw(*state_, view_);
        return renderer_->readImage();
    }
    /// A map in the upper part of the ball.
    Warp warpOf(double amount) {
        DeformationMap map;
        map.kind = MapKind::pull;
        map.half = {0.03, 0.03, 0.05};
        map.amount = amount;
        map.radius = 0.008;
        auto texture = DeformationTexture::bake(map, glm::ivec3(48), TexelFormat::half);
        EXPECT_TRUE(texture.ok());
        texture_.emplace(std::move(texture).value());
        Warp warp{&*texture_, {}};
        warp.mapping.objectFromLocal[3] = glm::dvec4(centre_ + glm::dvec3(0.005, 0.04, 0), 1);
        return warp;
    }
    void stage(const Warp& warp, double seam) {
        const auto nowhere = [](const glm::dvec3&) { return false; };
        const StageBox box = StageBox::of(warp, examineFaces(warp, nowhere), seam);
        caster_->setStage(box);
        ASSERT_TRUE(renderer_->openBox(0, box, lattice_, mesh_, binding_).ok());
    }
    static int apart(const Image& a, const Image& b, std::size_t pixel) {
        int most = 0;
        for (std::size_t c = 0; c < 3; ++c)
            most = std::max(most, std::abs(int(a.rgb[3 * pixel + c]) - int(b.rgb[3 * pixel + c])));
        return most;
    }

    SurfaceBinding binding_;
    std::optional<SurfaceRenderer> renderer_;
    std::optional<DistanceVolume> volume_;
    std::optional<Raycaster> caster_;
    std::optional<DeformationTexture> texture_;
    View view_;
};

// Wires are of the surface: each pixel still has its ray.
TEST_F(GlRaycastStage, WiresOfTheSurfaceLeaveWhatIsRayCast) {
    const Image whole = draw(sim::Show::implicit);
    view_.wireframe = true;
    const Image wires = draw(sim::Show::implicit);
    int differ = 0;
    for (std::size_t i = 0; i < std::size_t(kSize) * kSize; ++i)
        differ += apart(whole, wires, i) > 0;
    EXPECT_EQ(differ, 0);
}

// Where nothing moves, mesh and field are the same ball: each pixel of the composite lies between the two
// pictures that it is blended of, and no step is larger than theirs and the blending.
TEST_F(GlRaycastStage, ASeamIsNotSeen) {
    const Warp warp = warpOf(0);
    caster_->setWarp(warp);
    const Image mesh = draw(sim::Show::surface), cast = draw(sim::Show::implicit);
    view_.look.surface = false;
    const Image empty = draw(sim::Show::surface);
    view_.look.surface = true;
    stage(warp, 0.008);
    const Image both = draw(sim::Show::implicit, sim::Stage::composite);
    int outside = 0, holes = 0, object = 0, asMesh = 0, asCast = 0;
    for (std::size_t i = 0; i < std::size_t(kSize) * kSize; ++i) {
        // At its rim the mesh has shares of pixels, the field whole ones.
        const bool rim = (apart(mesh, empty, i) > 8) != (apart(cast, empty, i) > 8);
        object += !rim && apart(mesh, empty, i) > 8;
        holes += !rim && apart(mesh, empty, i) > 8 && apart(both, empty, i) <= 2;
        asMesh += apart(both, mesh, i) == 0 && apart(both, cast, i) > 0;
        asCast += apart(both, cast, i) == 0 && apart(both, mesh, i) > 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const int a = mesh.rgb[3 * i + c], b = cast.rgb[3 * i + c], m = both.rgb[3 * i + c];
            outside += m < std::min(a, b) - 6 || m > std::max(a, b) + 6;
        }
    }
    EXPECT_GT(object, 5000);
    EXPECT_EQ(holes, 0);
    EXPECT_EQ(outside, 0);
    EXPECT_GT(asMesh, 500) << "the lower part is the mesh's";
    EXPECT_GT(asCast, 500) << "the upper part is ray-cast";
}

// A lattice at rest takes every place from where it is: the box is where it was.
TEST_F(GlRaycastStage, LiesWhereTheLatticeHasIt) {
    const Warp warp = warpOf(0.03);
    caster_->setWarp(warp);
    stage(warp, 0.004);
    const Image still = draw(sim::Show::implicit, sim::Stage::box);
    auto lattice = LatticeWarp::create(lattice_, state_->layout());
    ASSERT_TRUE(lattice.ok()) << lattice.error().message;
    ASSERT_TRUE(lattice->update(*state_).ok());
    caster_->setLattice(&*lattice);
    const Image moved = draw(sim::Show::implicit, sim::Stage::box);
    caster_->setLattice(nullptr);
    view_.look.surface = false;
    const Image empty = draw(sim::Show::surface);
    int shown = 0, differs = 0;
    for (int y = kSize / 2; y < kSize; ++y) // below the spike, which leaves the lattice
        for (int x = 0; x < kSize; ++x) {
            const std::size_t i = std::size_t(y) * kSize + std::size_t(x);
            shown += apart(still, empty, i) > 8;
            differs += apart(still, moved, i) > 16;
        }
    EXPECT_GT(shown, 200);
    EXPECT_LT(differs, 0.02 * shown);
}

TEST_F(GlRaycastStage, PartsMakeTheWhole) {
    const Warp warp = warpOf(0.03);
    caster_->setWarp(warp);
    const Image whole = draw(sim::Show::implicit);
    view_.look.surface = false;
    const Image empty = draw(sim::Show::surface);
    view_.look.surface = true;
    stage(warp, 0.004);
    const Image both = draw(sim::Show::implicit, sim::Stage::composite);
    stage(warp, 0);
    caster_->setStage([&] {
        StageBox box = StageBox::of(warp, {}, 0);
        box.seamLow = box.seamHigh = glm::dvec3(0);
        return box;
    }());
    const Image mesh = draw(sim::Show::implicit, sim::Stage::mesh),
                box = draw(sim::Show::implicit, sim::Stage::box);
    int object = 0, differs = 0, none = 0, cutOut = 0, boxed = 0;
    for (std::size_t i = 0; i < std::size_t(kSize) * kSize; ++i) {
        const bool seen = apart(whole, empty, i) > 8;
        object += seen;
        differs += seen != (apart(both, empty, i) > 8);
        none += seen && apart(mesh, empty, i) <= 2 && apart(box, empty, i) <= 2;
        cutOut += seen && apart(mesh, empty, i) <= 2;
        boxed += apart(box, empty, i) > 8;
    }
    EXPECT_GT(object, 5000);
    EXPECT_LT(differs, 0.01 * object) << "the mesh's rim has shares of pixels";
    EXPECT_LT(none, 0.005 * object);
    EXPECT_GT(cutOut, 300) << "the spike is not the mesh's";
    EXPECT_GT(boxed, 1000);
    EXPECT_LT(boxed, object);
}

} // namespace
} // namespace serosa::render
