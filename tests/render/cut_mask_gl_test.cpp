// The rest-space mask that blades paint, in pictures whose content is known: a ball that is cut and pulled
// apart.
#include "render/cut_mask.h"
#include "render/mapping_measures.h"
#include "render/surface_renderer.h"
#include "shaders/shared_constants.h"
#include "tests/render/ball_fixture.h"

#include <algorithm>
#include <cmath>

namespace serosa::render {
namespace {

constexpr double kSpacing = 0.004, kRadius = 5.2 * kSpacing, kHeight = 0.08; // m
constexpr int kSize = 400;                                                   // pixels
constexpr double kPixel = kHeight / kSize;                                   // m
constexpr double kPlane = 0.3; // of the cut: x, lattice units, at rest

class GlCutMask : public test::GlBallTest {
protected:
    void SetUp() override {
        test::GlBallTest::SetUp();
        if (HasFatalFailure())
            return;
        makeBall(40, kSpacing);
        if (HasFatalFailure())
            return;
        binding_ = bindSurface(lattice_, mesh_, sim::Mapping::curvature);
        auto renderer = SurfaceRenderer::create(lattice_, mesh_, binding_, *state_, kSize, kSize);
        ASSERT_TRUE(renderer.ok()) << renderer.error().message;
        renderer_.emplace(std::move(renderer).value());
        sim::Camera camera;
        camera.projection = sim::Projection::orthographic;
        camera.direction = {0, 0, -1};
        camera.target = lattice_.toWorld(middle_);
        camera.height = kHeight;
        view_.camera = makeCamera(camera, mesh_.lowest(), mesh_.highest(), 1);
        view_.look.colour = sim::SurfaceColour::dynamicNormal;
    }
    void TearDown() override {
        renderer_.reset();
        test::GlBallTest::TearDown();
    }

    /// Through the whole ball at x = `at` from its middle, lattice units, from above in `parts` parts.
    std::vector<sim::Stroke> strokes(double at, int parts, double tilt = 0) const {
        std::vector<sim::Stroke> result;
        for (int i = 0; i < parts; ++i) {
            sim::Stroke stroke;
            for (const int end : {0, 1}) {
                const double y0 = 8 - 16.0 * i / parts, y1 = 8 - 16.0 * (i + 1) / parts, z = end ? 8 : -8;
                stroke.from[std::size_t(end)] = lattice_.toWorld(middle_ + glm::dvec3(at + tilt * z, y0, z));
                stroke.to[std::size_t(end)] = lattice_.toWorld(middle_ + glm::dvec3(at + tilt * z, y1, z));
            }
            stroke.continues = i > 0;
            result.push_back(stroke);
        }
        return result;
    }

    /// Cuts the ball, which lies as `place` says, and shows it. \param mask false: only the springs are cut.
    void cut(const std::vector<sim::Stroke>& all, bool mask,
             const std::function<glm::dvec3(const glm::dvec3&)>& place) {
        const sim::LatticeState now = deformedState(lattice_, place);
        state_->upload(now);
        connections_ = lattice_.connections;
        for (const sim::Stroke& stroke : all) {
            ASSERT_TRUE(!mask || renderer_->paintCut(0, lattice_, *state_, stroke).ok());
            sim::cutConnections(lattice_, now.positions, toLattice(stroke, lattice_), connections_);
        }
        ASSERT_TRUE(renderer_
                        ->showCuts(0, lattice_, mesh_, binding_, *state_, connections_,
                                   sim::Mapping::curvature, false)
                        .ok());
    }

    /// The nodes as `move` has them, cut as cut() left them.
    void show(const std::function<glm::dvec3(const glm::dvec3&)>& move) {
        sim::LatticeState now = deformedState(lattice_, move);
        now.connections = connections_;
        state_->upload(now);
    }

    Image draw() {
        renderer_->draw(*state_, view_);
        return renderer_->readImage();
    }
    Image backdrop() {
        view_.look.surface = false;
        const Image image = draw();
        view_.look.surface = true;
        return image;
    }
    static bool differs(const Image& a, const Image& b, int x, int y) {
        const std::size_t at = 3 * (std::size_t(y) * kSize + std::size_t(x));
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(int(a.rgb[at + c]) - int(b.rgb[at + c])) > 6)
                return true;
        return false;
    }
    /// Column of x, lattice units from the middle of the ball.
    static double column(double x) { return kSize * 0.5 + x * kSpacing / kPixel; }

    /// Half of the cut's width in voxels' size, lattice units: what the mask takes on each side.
    double halfWidth() const {
        const auto mask = CutMask::create(lattice_, state_->layout());
        return SRS_MASK_WIDTH / mask->voxelsPerSpacing();
    }

    SurfaceBinding binding_;
    std::optional<SurfaceRenderer> renderer_;
    std::vector<std::uint32_t> connections_;
    View view_;
};

// A surface that may be cut is drawn as it was until it is.
TEST_F(GlCutMask, ChangesNothingBeforeTheFirstCut) {
    const auto moved = [&](const glm::dvec3& q) { return q + glm::dvec3(0.1 * (q.y - middle_.y), 0, 0); };
    state_->upload(deformedState(lattice_, moved));
    view_.look.colour = sim::SurfaceColour::tissue; // the other colours change with the basis
    const Image before = draw();
    const auto placed = renderer_->readDeformedPositions(*state_, sim::Mapping::curvature);
    ASSERT_TRUE(renderer_->prepareCuts(0, lattice_, state_->layout()).ok());
    EXPECT_EQ(renderer_->readDeformedPositions(*state_, sim::Mapping::curvature), placed);
    const Image after = draw();
    int changed = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            changed += differs(after, before, x, y);
    EXPECT_LE(changed, 5) << "pixels: another program rounds otherwise along the outline";
}

// Halves that were pulled apart: between them nothing, and each ends at a straight line where it was cut, at
// rest or stretched away from the cut: what lies beside a lip's last nodes is stretched as they are.
TEST_F(GlCutMask, NothingIsDrawnBetweenTheSidesAndLipsAreStraight) {
    const Image empty = backdrop();
    constexpr double kApart = 2.5; // lattice units, each to its own side
    const auto rest = [](const glm::dvec3& q) { return q; };
    double stretch = 1;
    const auto apart = [&](const glm::dvec3& q) {
        const double x = q.x - middle_.x - kPlane;
        return q + glm::dvec3((stretch - 1) * x + (x > 0 ? kApart : -kApart), 0, 0);
    };
    double deviation[3];
    for (const int kind : {0, 1, 2}) {
        const bool mask = kind > 0;
        stretch = kind == 2 ? 1.3 : 1;
        cut(strokes(kPlane, 5), mask, rest);
        show(apart);
        const Image image = draw();
        const double half = mask ? stretch * halfWidth() : 0;
        double worst = 0;
        int between = 0, rows = 0;
        for (int y = int(kSize * 0.30); y < int(kSize * 0.70); ++y, ++rows) {
            int left = 0, right = kSize;
            for (int x = 0; x < kSize; ++x)
                if (differs(image, empty, x, y))
                    (x < column(kPlane) ? left = x + 1 : right = std::min(right, x));
            worst = std::max({worst, std::abs(left - column(kPlane - kApart - half)),
                              std::abs(right - column(kPlane + kApart + half))});
            for (int x = int(column(kPlane - kApart)) + 1; x < int(column(kPlane + kApart)) - 1; ++x)
                between += differs(image, empty, x, y);
        }
        EXPECT_EQ(mask ? between : 0, 0);
        deviation[kind] = worst;
    }
    EXPECT_LE(deviation[1], 1.5); // pixels, of 20 a spacing
    EXPECT_LE(deviation[2], 3) << "stretched by 0.3: an offset from its triangle keeps its length";
    EXPECT_GE(deviation[0], 8) << "without the mask lips follow the lattice: else this test shows nothing";
}

// A stroke meets the organ as it lies, and is found in rest space where it was painted.
TEST_F(GlCutMask, AStrokeOnADeformedOrganLandsWhereItCut) {
    const auto stretched = [&](const glm::dvec3& q) {
        return middle_ + glm::dvec3(1.5 * (q.x - middle_.x) + 1, q.y - middle_.y, q.z - middle_.z);
    };
    const auto rest = [](const glm::dvec3& q) { return q; };
    view_.look.colour = sim::SurfaceColour::tissue; // the other colours change with the basis
    view_.look.blood = false;
    state_->upload(deformedState(lattice_, rest));
    const Image whole = draw();
    constexpr double kAt = 2.8; // lattice units, deformed; at rest (2.8 - 1) / 1.5 = 1.2
    cut(strokes(kAt, 3), true, stretched);
    show(rest);
    const Image slit = draw();
    double sum = 0, count = 0;
    for (int y = int(kSize * 0.4); y < int(kSize * 0.6); ++y)
        for (int x = 0; x < kSize; ++x)
            if (differs(slit, whole, x, y)) {
                sum += x + 0.5;
                ++count;
            }
    ASSERT_GT(count, 100);
    EXPECT_NEAR(sum / count, column((kAt - 1) / 1.5), 1);
    // What the blade takes is as wide where it cut: at rest less by the stretch.
    EXPECT_NEAR(count / (kSize * 0.2), 2 * halfWidth() / 1.5 * kSpacing / kPixel, 2);
    for (std::size_t node = 0; node < lattice_.nodeCount(); ++node) // the springs say the same
        EXPECT_EQ(connections_[node] != lattice_.connections[node],
                  std::abs(lattice_.restPosition(node).x - middle_.x - 1.5) < 0.6);
}

// Saved and set again it is the same; cleared, nothing is cut.
TEST_F(GlCutMask, SavedBytesGiveTheSamePicture) {
    cut(strokes(kPlane, 2, 0.1), true, [](const glm::dvec3& q) { return q; });
    const Image image = draw();
    const std::string bytes = renderer_->saveCuts(0);
    const auto show = [&] {
        EXPECT_TRUE(renderer_
                        ->showCuts(0, lattice_, mesh_, binding_, *state_, connections_,
                                   sim::Mapping::curvature, false)
                        .ok());
        return draw();
    };
    ASSERT_TRUE(renderer_->restoreCuts(0, lattice_, *state_, {}).ok());
    EXPECT_NE(show().rgb, image.rgb);
    ASSERT_TRUE(renderer_->restoreCuts(0, lattice_, *state_, bytes).ok());
    EXPECT_EQ(show().rgb, image.rgb);
    EXPECT_EQ(renderer_->saveCuts(0), bytes);
    for (const std::size_t size : {std::size_t(3), bytes.size() / 2, bytes.size() - 1})
        EXPECT_FALSE(
            renderer_->restoreCuts(0, lattice_, *state_, std::string_view(bytes).substr(0, size)).ok());
}

// What CutList::undo gives back of springs, the mask gives back of what is drawn; a snapshot keeps what that
// needs.
TEST_F(GlCutMask, UndoneStrokeByStrokeItIsDrawnAsBefore) {
    const auto rest = [](const glm::dvec3& q) { return q; };
    view_.look.colour = sim::SurfaceColour::tissue;
    ASSERT_TRUE(renderer_->prepareCuts(0, lattice_, state_->layout()).ok());
    std::vector<Image> images;
    std::vector<std::vector<std::uint32_t>> connections;
    std::vector<sim::Stroke> all;
    const auto shown = [&] {
        EXPECT_TRUE(renderer_
                        ->showCuts(0, lattice_, mesh_, binding_, *state_, connections_,
                                   sim::Mapping::curvature, false)
                        .ok());
        return draw();
    };
    sim::Stroke tear;
    tear.kind = sim::StrokeKind::tear;
    cut({}, true, rest);
    renderer_->keepCutsForUndo(true);
    for (const std::vector<sim::Stroke>& stroke : {strokes(kPlane, 3), {tear}, strokes(-2.2, 2)}) {
        images.push_back(shown());
        connections.push_back(connections_);
        for (const sim::Stroke& part : stroke) {
            ASSERT_TRUE(renderer_->paintCut(0, lattice_, *state_, part).ok());
            if (part.kind == sim::StrokeKind::blade)
                sim::cutConnections(lattice_, deformedState(lattice_, rest).positions,
                                    toLattice(part, lattice_), connections_);
        }
    }
    EXPECT_NE(shown().rgb, images[2].rgb);
    EXPECT_NE(images[2].rgb, images[0].rgb);
    const std::string bytes = renderer_->saveCuts(0);
    for (const bool fromSnapshot : {false, true}) {
        if (fromSnapshot) {
            ASSERT_TRUE(renderer_->restoreCuts(0, lattice_, *state_, bytes).ok());
        }
        for (const std::size_t i : {2U, 1U, 0U}) {
            EXPECT_TRUE(renderer_->undoCut(0));
            connections_ = connections[i];
            EXPECT_EQ(shown().rgb, images[i].rgb) << i;
        }
        EXPECT_FALSE(renderer_->undoCut(0));
    }
}

// A blade that turns round on its way still counts its sides the same; a ball burns a hole.
TEST_F(GlCutMask, SidesStayThroughASawingStrokeAndABallBurnsAHole) {
    auto mask = CutMask::create(lattice_, state_->layout());
    ASSERT_TRUE(mask.ok());
    std::vector<sim::Stroke> saw = strokes(kPlane, 4);
    for (const std::size_t i : {1U, 3U})
        std::swap(saw[i].from, saw[i].to);
    for (const sim::Stroke& stroke : saw)
        mask->paint(*state_, lattice_, stroke);
    const std::vector<float> sides = mask->nodeSides();
    int last = 0;
    for (std::size_t node = 0; node < lattice_.nodeCount(); ++node) {
        const double x = lattice_.restPosition(node).x - middle_.x - kPlane;
        if (std::abs(x) > 2)
            continue;
        EXPECT_NEAR(std::abs(sides[node]), std::abs(x), 1e-4);
        const int sign = (sides[node] < 0) == (x < 0) ? 1 : -1;
        EXPECT_TRUE(last == 0 || sign == last);
        last = sign;
    }
    mask->clear();
    sim::Stroke ball;
    ball.kind = sim::StrokeKind::cauterize;
    ball.from[0] = lattice_.toWorld(middle_ + glm::dvec3(1.25, 0.5, -0.75));
    ball.radius = 1.5 * kSpacing;
    mask->paint(*state_, lattice_, ball);
    double burnt = 0;
    for (const std::uint32_t texel : mask->volume().download())
        burnt += (texel >> 24) < 128;
    const double expected = 4.0 / 3 * 3.14159 * std::pow(1.5 * mask->voxelsPerSpacing() + SRS_MASK_WIDTH, 3);
    EXPECT_NEAR(burnt, expected, 0.05 * expected);
}

} // namespace
} // namespace serosa::render
