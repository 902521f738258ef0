// Pictures whose content is known without a reference picture.
#include "render/mapping_measures.h"
#include "render/surface_renderer.h"
#include "tests/render/ball_fixture.h"

#include <cmath>
#include <numbers>

namespace serosa::render {
namespace {

constexpr double kSpacing = 0.004, kRadius = 5.2 * kSpacing; // m
constexpr int kSize = 256;                                   // pixels
constexpr double kHeight = 0.06;                             // m, of the orthographic picture

class GlSurfaceRenderer : public test::GlBallTest {
protected:
    void SetUp() override {
        test::GlBallTest::SetUp();
        if (HasFatalFailure())
            return;
        makeBall(24, kSpacing);
        if (HasFatalFailure())
            return;
        auto renderer = SurfaceRenderer::create(
            lattice_, mesh_, bindSurface(lattice_, mesh_, sim::Mapping::curvature), *state_, kSize, kSize);
        ASSERT_TRUE(renderer.ok()) << renderer.error().message;
        renderer_.emplace(std::move(renderer).value());
        sim::Camera camera;
        camera.projection = sim::Projection::orthographic;
        camera.direction = {0, 0, -1};
        camera.target = centre_;
        camera.height = kHeight;
        view_.camera = makeCamera(camera, mesh_.lowest(), mesh_.highest(), 1);
    }
    void TearDown() override {
        renderer_.reset();
        test::GlBallTest::TearDown();
    }
    Image draw() {
        renderer_->draw(*state_, view_);
        return renderer_->readImage();
    }
    static glm::ivec3 pixel(const Image& image, int x, int y) {
        const std::uint8_t* p = &image.rgb[std::size_t(y * image.width + x) * 3];
        return {p[0], p[1], p[2]};
    }
    /// Share of the picture that is nearer to `on` than to `off` in one channel, with partial coverage
    /// counted as such.
    static double share(const Image& with, const Image& without, int threshold) {
        double count = 0;
        for (std::size_t i = 0; i < with.rgb.size(); i += 3) {
            int difference = 0;
            for (std::size_t c = 0; c < 3; ++c)
                difference = std::max(difference, std::abs(int(with.rgb[i + c]) - int(without.rgb[i + c])));
            count += difference > threshold;
        }
        return count / (double(with.rgb.size()) / 3);
    }

    std::optional<SurfaceRenderer> renderer_;
    View view_;
};

TEST_F(GlSurfaceRenderer, SilhouetteOfABallHasItsArea) {
    view_.look.colour = sim::SurfaceColour::dynamicNormal;
    const Image ball = draw();
    view_.look.surface = false;
    const Image empty = draw();
    const double expected = std::numbers::pi * kRadius * kRadius / (kHeight * kHeight);
    // pixels on the rim count when any part differs visibly: half a pixel around the rim
    const double rim = std::numbers::pi * 2 * kRadius / kHeight / kSize * 0.5;
    EXPECT_NEAR(share(ball, empty, 8), expected + 0.7 * rim, 0.01 * expected);
}

TEST_F(GlSurfaceRenderer, BallIsRoundCentredAndUpright) {
    view_.look.surface = false;
    const Image empty = draw();
    view_.look.surface = true;
    view_.look.colour = sim::SurfaceColour::dynamicNormal;
    // Move everything up by a quarter of the picture's height and right by an eighth.
    const glm::dvec3 shift(kHeight / 8 / kSpacing, kHeight / 4 / kSpacing, 0);
    state_->upload(deformedState(lattice_, [&](const glm::dvec3& q) { return 0.5 * q + shift; }));
    const Image moved = draw();
    double sumX = 0, sumY = 0, count = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            if (pixel(moved, x, y) != pixel(empty, x, y)) {
                sumX += x + 0.5;
                sumY += y + 0.5;
                ++count;
            }
    ASSERT_GT(count, 100);
    const glm::dvec3 middle = lattice_.toWorld(0.5 * lattice_.toLattice(centre_) + shift) - centre_;
    EXPECT_NEAR(sumX / count, kSize * (0.5 + middle.x / kHeight), 1);
    EXPECT_NEAR(sumY / count, kSize * (0.5 - middle.y / kHeight), 1); // row 0 is the top
}

TEST_F(GlSurfaceRenderer, ColoursOfTheNormalTurnWithTheLattice) {
    view_.look.colour = sim::SurfaceColour::dynamicNormal;
    const glm::ivec3 front = pixel(draw(), kSize / 2, kSize / 2);
    EXPECT_GT(front.z, front.x + 20); // towards the eye is +z: blue
    EXPECT_NEAR(front.x, front.y, 25);
    // A quarter turn about y brings what faced +x to the front; its dynamic normal is +z again, so the colour
    // stays.
    const glm::dvec3 c = lattice_.toLattice(centre_);
    state_->upload(deformedState(lattice_, [&](const glm::dvec3& q) {
        const glm::dvec3 p = q - c;
        return c + glm::dvec3(-p.z, p.y, p.x);
    }));
    const glm::ivec3 turned = pixel(draw(), kSize / 2, kSize / 2);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(turned[i], front[i], 6);
}

TEST_F(GlSurfaceRenderer, SameStateGivesTheSameBytes) {
    EXPECT_EQ(draw().rgb, draw().rgb);
    for (const std::uint8_t corner : {draw().rgb[0], draw().rgb.back()})
        EXPECT_LT(corner, 60); // the backdrop is dark
}

TEST_F(GlSurfaceRenderer, SectionShowsEvenCutTissueAndKeepsTheRest) {
    view_.look.sectionAt = centre_;
    const Image half = draw(); // the near half is gone: a disc of cut tissue, all of one colour
    const glm::ivec3 cut = pixel(half, kSize / 2, kSize / 2);
    EXPECT_EQ(pixel(half, kSize / 2 + 60, kSize / 2 + 30), cut);
    view_.look.surface = false;
    const double expected = std::numbers::pi * kRadius * kRadius / (kHeight * kHeight);
    EXPECT_NEAR(share(half, draw(), 8), expected, 0.03 * expected);
    view_.look.surface = true;
    view_.look.sectionNormal = {1, 0, 0}; // the right half is gone
    const Image left = draw();
    view_.look.sectionAt.reset();
    const Image whole = draw();
    EXPECT_EQ(pixel(left, kSize / 2 - 30, kSize / 2), pixel(whole, kSize / 2 - 30, kSize / 2));
    EXPECT_NE(pixel(left, kSize / 2 + 30, kSize / 2), pixel(whole, kSize / 2 + 30, kSize / 2));
}

TEST_F(GlSurfaceRenderer, OneToOneShowsTheCellsOutline) {
    view_.look.surface = false;
    const Image empty = draw();
    view_.look.surface = true;
    view_.look.mapping = sim::Mapping::oneToOne;
    // Seen along z the lattice covers each column that holds a cell.
    std::vector<bool> column(std::size_t(lattice_.nodeDims.x * lattice_.nodeDims.y), false);
    for (const sim::LatticeCell& cell : lattice_.cells)
        column[std::size_t(cell.grid.y * lattice_.nodeDims.x + cell.grid.x)] = true;
    const auto columns = double(std::count(column.begin(), column.end(), true));
    const double expected = columns * kSpacing * kSpacing / (kHeight * kHeight);
    EXPECT_NEAR(share(draw(), empty, 8), expected, 0.03 * expected);
}

TEST_F(GlSurfaceRenderer, ToolHidesWhatIsBehindItAndLatticeLinesAreThin) {
    const Image bare = draw();
    DrawnShape ball;
    ball.shape.radius = 0.25 * kRadius;
    ball.pose.at = centre_ + glm::dvec3(0, 0, 1.2 * kRadius);
    view_.shapes = {ball};
    const Image tool = draw();
    const double disc = std::numbers::pi * std::pow(0.25 * kRadius / kHeight, 2);
    EXPECT_GE(share(tool, bare, 10), 0.9 * disc);
    view_.look.tools = false;
    EXPECT_EQ(draw().rgb, bare.rgb);
    view_.look.lattice = true;
    const double lines = share(draw(), bare, 10);
    EXPECT_GT(lines, 0.02);
    EXPECT_LT(lines, 0.5);
}

// Without the organ, each shape covers as much of the picture as its outline, seen along z or turned so.
// Pixels on the outline count whole: less than half a pixel's width around it, below 3% here.
TEST_F(GlSurfaceRenderer, ToolsOfEveryShapeCoverTheirOutline) {
    constexpr double r = 0.1 * kHeight, length = 0.35 * kHeight, pi = std::numbers::pi;
    view_.look.surface = false;
    const Image bare = draw();
    const auto covers = [&](const sim::RigidShape& shape, const glm::dquat& turn, double area,
                            Finish finish) {
        view_.shapes = {DrawnShape{shape, {centre_ - glm::dvec3(0.02 * kHeight, 0, 0), turn}, finish, 0}};
        const double expected = area / (kHeight * kHeight);
        EXPECT_NEAR(share(draw(), bare, 8), expected, 0.06 * expected) << int(shape.kind);
    };
    const glm::dquat straight(1, 0, 0, 0),
        up = glm::angleAxis(-pi / 2, glm::dvec3(1, 0, 0)),
        across = glm::angleAxis(pi / 2, glm::dvec3(0, 1, 0)); // own z to y, to x
    sim::RigidShape shape;
    shape.radius = r;
    shape.length = length;
    covers(shape, straight, pi * r * r, Finish::steel);
    shape.kind = sim::ShapeKind::capsule;
    covers(shape, straight, pi * r * r, Finish::matte);
    covers(shape, up, pi * r * r + 2 * r * length, Finish::matte);
    covers(shape, across, pi * r * r + 2 * r * length, Finish::steel);
    shape.kind = sim::ShapeKind::box;
    shape.halfSize = {r, 2 * r, 3 * r};
    covers(shape, straight, 4 * r * 2 * r + 2 * r * (2 * r + 4 * r) + pi * r * r, Finish::matte);
    covers(shape, across, 4 * r * 6 * r + 2 * r * (4 * r + 6 * r) + pi * r * r, Finish::matte);
    shape.kind = sim::ShapeKind::hook;
    shape.bend = 3 * r;
    covers(shape, across, pi * r * r + 2 * r * (length + pi * shape.bend), Finish::matte);
}

// A floor hides what is below it, and is not seen from there.
TEST_F(GlSurfaceRenderer, FloorIsSeenFromAbove) {
    sim::Camera camera;
    camera.projection = sim::Projection::orthographic;
    camera.height = kHeight;
    DrawnShape floor;
    floor.shape.kind = sim::ShapeKind::halfSpace;
    floor.shape.radius = 0;
    floor.pose.at = centre_;
    floor.finish = Finish::floor;
    floor.extent = 4 * kHeight; // fades out beyond the picture
    for (const bool above : {true, false}) {
        camera.direction = {0, above ? -1 : 1, -0.2};
        view_.camera = makeCamera(camera, mesh_.lowest(), mesh_.highest(), 1);
        view_.shapes.clear();
        const Image bare = draw();
        view_.shapes = {floor};
        const double changed = share(draw(), bare, 4);
        const double ball = std::numbers::pi * std::pow(kRadius / kHeight, 2);
        if (above)
            EXPECT_GT(changed, 0.95 - ball);
        else
            EXPECT_EQ(changed, 0);
    }
}

/// A twin of the fixture's ball in the same renderer, its centre moved by `by`; the picture of both.
class GlTwoOrgans : public GlSurfaceRenderer {
protected:
    Image drawBoth(const glm::dvec3& by, bool twinFirst) {
        sim::Lattice lattice = lattice_;
        lattice.origin += by;
        sim::TriangleMesh mesh = mesh_;
        for (glm::dvec3& position : mesh.positions)
            position += by;
        const auto make = [&](const sim::Lattice& l, const sim::TriangleMesh& m) {
            return SurfaceRenderer::create(l, m, bindSurface(l, m, sim::Mapping::curvature), *state_, kSize,
                                           kSize);
        };
        auto renderer = twinFirst ? make(lattice, mesh) : make(lattice_, mesh_);
        EXPECT_TRUE(renderer.ok());
        const sim::Lattice& l = twinFirst ? lattice_ : lattice;
        const sim::TriangleMesh& m = twinFirst ? mesh_ : mesh;
        EXPECT_TRUE(renderer->addOrgan(l, m, bindSurface(l, m, sim::Mapping::curvature), *state_).ok());
        renderer->draw(OrganStates{&*state_, &*state_}, view_);
        const auto positions = renderer->readDeformedPositions(*state_, sim::Mapping::curvature, 1);
        EXPECT_LE(glm::distance(positions[7], m.positions[7]), 2e-6 * kRadius);
        return renderer->readImage();
    }
};

TEST_F(GlTwoOrgans, TheNearerHidesTheOther) {
    const Image alone = draw();
    // Seen along z under parallel light, a twin in front or behind looks like the ball alone.
    for (const double z : {-2.5 * kRadius, 2.5 * kRadius})
        for (const bool twinFirst : {false, true})
            EXPECT_LT(share(drawBoth({0, 0, z}, twinFirst), alone, 12), 2e-3) << z << " " << twinFirst;
    // Beside it, both are seen, whichever was added first.
    const glm::dvec3 aside(0, 0.4 * kRadius, -2.5 * kRadius); // above, where it is lit
    const Image both = drawBoth(aside, false);
    const double disc = std::numbers::pi * std::pow(kRadius / kHeight, 2);
    const double lens = 2 * std::acos(0.2) - 0.2 * std::sqrt(4 - 0.16); // of r^2, centres 0.4 r apart
    EXPECT_NEAR(share(both, alone, 12), disc * (1 - lens / std::numbers::pi), 0.1 * disc);
    EXPECT_LT(share(both, drawBoth(aside, true), 2), 1e-6);
}

// A rod with round ends from the middle of one ball to that of a twin, and half of the way within each.
TEST_F(GlTwoOrgans, AThreadIsDrawnBetweenThem) {
    view_.look.surface = false;
    const glm::dvec3 by(0.25 * kHeight, 0.3 * kHeight, 0.1 * kHeight);
    const Image bare = drawBoth(by, false);
    DrawnThread thread;
    thread.radius = 0.02 * kHeight;
    thread.ends[1].organ = 1;
    const auto middle = std::uint32_t(lattice_.nodeAt(glm::ivec3(6)));
    for (DrawnThread::End& end : thread.ends) {
        end.nodes.fill(middle);
        end.weights = {0.25, 0.75, 0, 0, 0, 0, 0, 0};
    }
    view_.threads = {thread};
    const double length = std::hypot(by.x, by.y), r = thread.radius;
    const double expected = (std::numbers::pi * r * r + 2 * r * length) / (kHeight * kHeight);
    const Image drawn = drawBoth(by, false);
    EXPECT_NEAR(share(drawn, bare, 8), expected, 0.08 * expected);
    const glm::ivec3 colour = pixel(drawn, kSize / 2 + kSize / 8, kSize / 2 - int(0.15 * kSize));
    EXPECT_GT(colour.z, colour.x + 20) << "blue";
    view_.look.tools = false;
    EXPECT_EQ(share(drawBoth(by, false), bare, 0), 0) << "hidden with the tools";
}

TEST_F(GlSurfaceRenderer, SurfaceFilesAreInMeshOrderAndMetres) {
    for (const auto mapping : {sim::Mapping::triangle, sim::Mapping::curvature}) {
        const std::vector<glm::dvec3> positions = renderer_->readDeformedPositions(*state_, mapping);
        ASSERT_EQ(positions.size(), mesh_.positions.size());
        for (std::size_t v = 0; v < positions.size(); ++v)
            ASSERT_LE(glm::distance(positions[v], mesh_.positions[v]), 2e-6 * kRadius);
    }
}

TEST_F(GlSurfaceRenderer, EveryVertexStageRunsWithoutATarget) {
    renderer_->drawVertexStageOnly(*state_, std::nullopt); // GL errors fail the test
    for (const sim::Mapping mapping : {sim::Mapping::triangle, sim::Mapping::curvature})
        renderer_->drawVertexStageOnly(*state_, mapping);
    EXPECT_GE(renderer_->samples(), 4);
}

} // namespace
} // namespace serosa::render
