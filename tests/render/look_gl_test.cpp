// What the look of the surface promises, in pictures whose content is known: textures ride with the tissue,
// shadows and occlusion only darken, what is skipped cannot be seen.
#include "render/mapping_measures.h"
#include "render/surface_passes.h"
#include "render/surface_renderer.h"
#include "tests/gl_fixture.h"
#include "tests/render/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace serosa::render {
namespace {

constexpr double kSpacing = 0.004, kRadius = 6.2 * kSpacing; // m
constexpr int kSize = 256;                                   // pixels

class GlLook : public test::GlTest {
protected:
    void prepare(int side, const SurfaceDetail* detail = nullptr, bool uvs = false) {
        lattice_ = test::ballLattice(kRadius / kSpacing, kSpacing, {0.1, 1.6, -0.4});
        middle_ = lattice_.toWorld(glm::dvec3(7 - lattice_.centre));
        mesh_ = test::ballMesh(side, kRadius, middle_);
        for (const glm::uvec3& face : mesh_.faces)
            for (int i = 0; i < 3 && uvs; ++i) {
                const glm::dvec3 p = (mesh_.positions[face[i]] - middle_) / kRadius;
                mesh_.uvs.emplace_back(2 * p.x + 0.3 * p.z, 2 * p.y);
            }
        auto state = sim::StateTextures::create(lattice_, {});
        ASSERT_TRUE(state.ok());
        state_.emplace(std::move(state).value());
        auto renderer =
            SurfaceRenderer::create(lattice_, mesh_, bindSurface(lattice_, mesh_, sim::Mapping::curvature),
                                    *state_, kSize, kSize, detail);
        ASSERT_TRUE(renderer.ok()) << renderer.error().message;
        renderer_.emplace(std::move(renderer).value());
        camera_.direction = {-0.3, -0.2, -1};
        view_.camera = makeCamera(camera_, mesh_.lowest(), mesh_.highest(), 1);
    }
    void TearDown() override {
        renderer_.reset();
        state_.reset();
        test::GlTest::TearDown();
    }
    Image draw() {
        renderer_->draw(*state_, view_);
        return renderer_->readImage();
    }
    /// Pixels of which a channel is higher in `a` than in `b` by more than `by`.
    static int brighter(const Image& a, const Image& b, int by) {
        int count = 0;
        for (std::size_t i = 0; i < a.rgb.size(); i += 3)
            count += int(a.rgb[i]) > b.rgb[i] + by || int(a.rgb[i + 1]) > b.rgb[i + 1] + by ||
                     int(a.rgb[i + 2]) > b.rgb[i + 2] + by;
        return count;
    }
    static int differing(const Image& a, const Image& b, int by) {
        return brighter(a, b, by) + brighter(b, a, by);
    }

    static SurfaceDetail detail() {
        return {makeTissue(sim::TissueTexture::fat, 0.02, 0.0008), 0.02, 0.0008};
    }

    sim::Lattice lattice_;
    glm::dvec3 middle_{0};
    sim::TriangleMesh mesh_;
    std::optional<sim::StateTextures> state_;
    std::optional<SurfaceRenderer> renderer_;
    sim::Camera camera_;
    View view_;
};

// Organ, camera and lamp turned together about the upright axis: the picture stays. A texture that were read
// where the tissue is now, and not where it rests, would swim.
class GlLookTurned : public GlLook, public ::testing::WithParamInterface<bool> {};

TEST_P(GlLookTurned, TextureRidesWithTheTissue) {
    const SurfaceDetail texture = detail();
    prepare(32, &texture, GetParam());
    view_.look.shadows = true;
    const Image rest = draw();
    constexpr double kTurn = 0.7; // rad
    const double c = std::cos(kTurn), s = std::sin(kTurn);
    const glm::dvec3 at = lattice_.toLattice(middle_);
    const auto turned = [&](const glm::dvec3& p) {
        return glm::dvec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
    };
    state_->upload(deformedState(lattice_, [&](const glm::dvec3& q) { return at + turned(q - at); }));
    view_.camera = carriedAround(view_.camera, middle_, kTurn);
    const glm::dvec3 direction = view_.light.direction;
    const Image unlit = draw();
    view_.light.direction = turned(direction);
    const Image image = draw();
    // Shadows of another texel here and there at the terminator; nothing where the texture is.
    EXPECT_LE(differing(image, rest, 8), kSize * kSize / 200);
    EXPECT_GE(differing(unlit, rest, 8), kSize * kSize / 50)
        << "the picture depends on nothing that was turned";
    renderer_.reset();
    state_.reset();
    prepare(32, nullptr); // the texture is there at all
    view_.look.shadows = true;
    EXPECT_GE(differing(draw(), rest, 8), kSize * kSize / 20);
}

INSTANTIATE_TEST_SUITE_P(Coordinates, GlLookTurned, ::testing::Bool());

// With a relief the light breaks otherwise; with none the colour alone is there.
TEST_F(GlLook, ReliefIsLit) {
    SurfaceDetail flat = detail();
    flat.relief = 0;
    flat.maps = makeTissue(sim::TissueTexture::fat, 0.02, 0);
    prepare(32, &flat);
    const Image without = draw();
    renderer_.reset();
    state_.reset();
    const SurfaceDetail raised = detail();
    prepare(32, &raised);
    EXPECT_GE(differing(draw(), without, 6), kSize * kSize / 20);
}

// A rod over the ball throws a shadow; nothing gets brighter, and without it next to nothing changes.
TEST_F(GlLook, ShadowsOfToolsFallOnTheOrgan) {
    prepare(32);
    view_.light.direction = {0, -1, -0.6};
    DrawnShape rod;
    rod.shape.kind = sim::ShapeKind::capsule;
    rod.shape.radius = 0.1 * kRadius;
    rod.shape.length = 4 * kRadius;
    rod.pose = {middle_ + glm::dvec3(-2 * kRadius, 1.6 * kRadius, 0.8 * kRadius),
                glm::angleAxis(std::numbers::pi / 2, glm::dvec3(0, 1, 0))};
    for (const bool tool : {false, true}) {
        view_.shapes.clear();
        if (tool)
            view_.shapes = {rod};
        view_.look.shadows = false;
        const Image lit = draw();
        view_.look.shadows = true;
        const Image shaded = draw();
        EXPECT_LE(brighter(shaded, lit, 3), 0);
        if (tool) {
            EXPECT_GE(brighter(lit, shaded, 25), kSize * kSize / 200);
        } else {
            EXPECT_LE(brighter(lit, shaded, 25), kSize * kSize / 200);
        }
    }
}

// Where a tool touches the ball both are darker; the open front of it stays as it is.
TEST_F(GlLook, OcclusionDarkensWhatLiesCloseTogether) {
    prepare(32);
    DrawnShape block;
    block.shape.kind = sim::ShapeKind::box;
    block.shape.halfSize = {0.2 * kRadius, 1.2 * kRadius, 1.2 * kRadius}; // a wall to the left
    block.pose.at = middle_ - glm::dvec3(1.15 * kRadius, 0, 0);
    camera_.direction = {-0.3, 0, -1};
    view_.camera = makeCamera(camera_, mesh_.lowest(), mesh_.highest(), 1);
    view_.shapes = {block};
    const Image without = draw();
    view_.look.occlusion = true;
    const Image with = draw();
    EXPECT_EQ(brighter(with, without, 3), 0);
    EXPECT_GE(brighter(without, with, 10), kSize * kSize / 300);
    int front = 0;
    for (int y = kSize * 2 / 5; y < kSize / 2; ++y)
        for (int x = kSize * 2 / 5; x < kSize * 3 / 5; ++x)
            front += std::abs(int(with.rgb[3 * std::size_t(y * kSize + x)]) -
                              int(without.rgb[3 * std::size_t(y * kSize + x)])) > 10;
    EXPECT_EQ(front, 0);
}

// What is skipped cannot be seen: not a byte differs, from afar and from near, at rest and bent.
TEST_F(GlLook, SkippedClustersCannotBeSeen) {
    prepare(72); // 62,208 faces
    ASSERT_TRUE(renderer_
                    ->prepareSkipping(0, lattice_, mesh_,
                                      bindSurface(lattice_, mesh_, sim::Mapping::curvature), *state_)
                    .ok());
    view_.surfaceError = 0;
    const glm::dvec3 at = lattice_.toLattice(middle_);
    for (const double bend : {0.0, 0.04}) {
        state_->upload(deformedState(lattice_, [&](const glm::dvec3& q) {
            const glm::dvec3 p = q - at;
            return at + glm::dvec3(p.x + bend * p.y * p.y, p.y, p.z * (1 + bend * p.x));
        }));
        for (const double zoom : {1.0, 5.0}) {
            camera_.zoom = zoom;
            view_.camera = makeCamera(camera_, mesh_.lowest(), mesh_.highest(), 1);
            view_.cull = true;
            const Image skipped = draw();
            const std::size_t triangles = renderer_->trianglesDrawn();
            view_.cull = false;
            EXPECT_EQ(draw().rgb, skipped.rgb);
            EXPECT_EQ(renderer_->trianglesDrawn(), mesh_.faces.size());
            EXPECT_LE(triangles, mesh_.faces.size() * (zoom > 1 ? 35 : 90) / 100);
            EXPECT_GT(triangles, 1000U);
        }
    }
}

// Small in the picture, a fine surface is drawn with fewer triangles, and looks the same.
TEST_F(GlLook, SmallSurfacesAreDrawnWithFewerTriangles) {
    prepare(96); // 110,592 faces
    view_.cull = false;
    camera_.zoom = 0.5;
    view_.camera = makeCamera(camera_, mesh_.lowest(), mesh_.highest(), 1);
    const Image fewer = draw();
    const std::size_t triangles = renderer_->trianglesDrawn();
    view_.surfaceError = 0;
    const Image all = draw();
    EXPECT_EQ(renderer_->trianglesDrawn(), mesh_.faces.size());
    EXPECT_LE(triangles, mesh_.faces.size() / 3);
    EXPECT_LE(differing(fewer, all, 8), kSize * kSize / 100);
    view_.surfaceError = 0.5;
    camera_.zoom = 40;
    view_.camera = makeCamera(camera_, mesh_.lowest(), mesh_.highest(), 1);
    draw();
    EXPECT_EQ(renderer_->trianglesDrawn(), mesh_.faces.size()) << "from near";
}

} // namespace
} // namespace serosa::render
