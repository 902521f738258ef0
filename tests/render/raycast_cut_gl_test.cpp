// The simulation's cuts in what is ray-cast, where the answer is known: a ball that a blade cut through,
// whose halves are moved and turned apart, against the rays' closed form.
#include "render/cut_surface.h"
#include "render/lattice_warp.h"
#include "render/mapping_measures.h"
#include "render/raycaster.h"
#include "render/surface_passes.h"
#include "shaders/shared_constants.h"
#include "sim/blade.h"
#include "sim/pieces.h"
#include "tests/render/ball_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace serosa::render {
namespace {

constexpr double kSpacing = 0.004, kRadius = 5.2 * kSpacing, kHeight = 0.08; // m
constexpr int kWidth = 160, kRows = 120;                                     // pixels
constexpr double kPixel = kHeight / kRows;                                   // m
constexpr double kPlane = 0.3,
                 kTilt = 0.2;        // of the cut: x = kPlane + kTilt z from the ball's middle, spacings
constexpr double kThickness = 0.006; // of the shell, m

/// A half that moves as a rigid body: shown = turn (rest - middle) + middle + move, spacings.
struct Half {
    double side; // of the plane
    glm::dmat3 turn;
    glm::dvec3 move;
};

/// What a ray meets, spacings.
struct Met {
    bool any = false, face = false;
    double t = std::numeric_limits<double>::infinity();
    glm::dvec3 normal{0};
};

/// Depths of a picture of what `draw` draws, 0 to 1.
class Drawn {
public:
    template <class Draw>
    explicit Drawn(const Draw& draw) : depths_(std::size_t(kWidth * kRows)) {
        gpu::Texture2D colour("colour", GL_RGBA8, kWidth, kRows),
            depth("depth", GL_DEPTH_COMPONENT32F, kWidth, kRows);
        gpu::Framebuffer target("depths");
        target.attach(GL_COLOR_ATTACHMENT0, colour);
        target.attach(GL_DEPTH_ATTACHMENT, depth);
        target.setDrawBuffers(1);
        target.bind(kWidth, kRows);
        glClear(GL_DEPTH_BUFFER_BIT);
        glEnable(GL_DEPTH_TEST);
        glEnable(GL_CULL_FACE);
        draw();
        glDisable(GL_CULL_FACE);
        glDisable(GL_DEPTH_TEST);
        depth.download(depths_.data(), depths_.size() * sizeof(float));
    }
    /// \param y from above
    double at(int x, int y) const { return depths_[std::size_t((kRows - 1 - y) * kWidth + x)]; }
    static double perMetre(const CameraView& orthographic) {
        return 0.5 * std::abs(orthographic.clipFromCamera[2][2]);
    }

private:
    std::vector<float> depths_;
};

class GlRaycastCut : public test::GlBallTest {
protected:
    void SetUp() override {
        test::GlBallTest::SetUp();
        if (HasFatalFailure())
            return;
        makeBall(28, kSpacing);
        if (HasFatalFailure())
            return;
        auto mask = CutMask::create(lattice_, state_->layout());
        ASSERT_TRUE(mask.ok());
        mask_.emplace(std::move(*mask));
        auto warp = LatticeWarp::create(lattice_, state_->layout());
        ASSERT_TRUE(warp.ok());
        warp_.emplace(std::move(*warp));
        auto volume = DistanceVolume::create(
            mesh_, VolumeGrid::around(mesh_.lowest(), mesh_.highest(), 40, 3), kThickness);
        ASSERT_TRUE(volume.ok());
        volume_.emplace(std::move(*volume));
        auto caster = Raycaster::create(lattice_, *volume_);
        ASSERT_TRUE(caster.ok());
        caster_.emplace(std::move(*caster));
        caster_->setLattice(&*warp_);
        normal_ = glm::normalize(glm::dvec3(1, 0, -kTilt));
        half_ = SRS_MASK_WIDTH / mask_->voxelsPerSpacing();
        const double angle = 0.25;
        halves_[0] = {1, glm::dmat3(1), {1.6, 0.2, 0}};
        halves_[0].turn[0] = {std::cos(angle), std::sin(angle), 0};
        halves_[0].turn[1] = {-std::sin(angle), std::cos(angle), 0};
        halves_[1] = {-1, glm::dmat3(1), {-1.6, 0, -0.4}};
    }
    void TearDown() override {
        caster_.reset();
        volume_.reset();
        warp_.reset();
        mask_.reset();
        test::GlBallTest::TearDown();
    }

    double side(const glm::dvec3& rest) const {
        return glm::dot(rest - middle_ - glm::dvec3(plane_, 0, 0), normal_);
    }

    /// Through the whole ball at rest.
    sim::Stroke stroke() const {
        sim::Stroke stroke;
        for (const int end : {0, 1}) {
            const double z = end ? 8 : -8, x = plane_ + tilt_ * z;
            stroke.from[std::size_t(end)] = lattice_.toWorld(middle_ + glm::dvec3(x, 8, z));
            stroke.to[std::size_t(end)] = lattice_.toWorld(middle_ + glm::dvec3(x, -8, z));
        }
        return stroke;
    }

    /// What it cut, the halves moved apart.
    sim::LatticeState cutAndOpened() const {
        sim::LatticeState now = sim::restState(lattice_);
        now.connections = lattice_.connections;
        sim::cutConnections(lattice_, now.positions, toLattice(stroke(), lattice_), now.connections);
        for (std::size_t node = 0; node < lattice_.nodeCount(); ++node) {
            const glm::dvec3 rest = lattice_.restPosition(node);
            const Half& half = halves_[side(rest) > 0 ? 0 : 1];
            now.positions[node] = glm::vec3(half.turn * (rest - middle_) + middle_ + half.move);
        }
        return now;
    }
    void cutAndOpen() {
        mask_->paint(*state_, lattice_, stroke());
        state_->upload(cutAndOpened());
        ASSERT_TRUE(warp_->update(*state_, &*mask_).ok());
    }

    /// The first of the halves on a ray, spacings.
    Met meet(const glm::dvec3& from, const glm::dvec3& along) const {
        Met met;
        for (const Half& half : halves_) {
            const glm::dmat3 back = glm::transpose(half.turn);
            const glm::dvec3 p = back * (from - half.move - middle_), v = back * along;
            const double middle = -glm::dot(p, v), miss2 = glm::dot(p, p) - middle * middle,
                         r = kRadius / kSpacing;
            if (miss2 >= r * r)
                continue;
            double enter = middle - std::sqrt(r * r - miss2), leave = 2 * middle - enter;
            glm::dvec3 normal = (p + enter * v) / r;
            bool face = false;
            const double at = half.side * side(p + middle_) - half_, slope = half.side * glm::dot(v, normal_),
                         cross = -at / slope;
            if (slope > 0 && cross > enter) {
                enter = cross;
                normal = -half.side * normal_;
                face = true;
            } else if (slope <= 0) {
                leave = std::min(leave, cross);
            }
            if (enter < leave && enter < met.t)
                met = {true, face, enter, half.turn * normal};
        }
        return met;
    }

    struct View {
        CameraView camera;
        Frame frame;
    };
    View view(const glm::dvec3& direction) const {
        sim::Camera settings;
        settings.projection = sim::Projection::orthographic;
        settings.direction = direction;
        settings.target = lattice_.toWorld(middle_);
        settings.height = kHeight;
        View made;
        made.camera = makeCamera(settings, mesh_.lowest(), mesh_.highest(), double(kWidth) / kRows);
        made.frame = makeFrame(lattice_, made.camera, {}, {}, kWidth, kRows);
        return made;
    }
    /// Of pixel i, top row first; spacings.
    void ray(const View& view, std::size_t i, glm::dvec3& from, glm::dvec3& along) const {
        const double x = 2 * (double(i % kWidth) + 0.5) / kWidth - 1,
                     y = 1 - 2 * (double(i / kWidth) + 0.5) / kRows;
        const glm::dmat4 worldFromClip =
            glm::inverse(view.camera.clipFromCamera * view.camera.cameraFromWorld);
        const auto at = [&](double depth) {
            const glm::dvec4 p = worldFromClip * glm::dvec4(x, y, depth, 1);
            return lattice_.toLattice(glm::dvec3(p) / p.w);
        };
        from = at(-1);
        along = glm::normalize(at(1) - from);
    }
    std::vector<RaycastProbe> probe(const View& view, Solid solid) {
        RaycastLook look;
        look.solid = solid;
        look.thickness = kThickness;
        auto probes = caster_->probe(view.frame, look, kWidth, kRows);
        EXPECT_TRUE(probes.ok());
        return probes.ok() ? *probes : std::vector<RaycastProbe>();
    }

    double plane_ = kPlane, tilt_ = kTilt;
    glm::dvec3 normal_{1, 0, 0};
    double half_ = 0; // of what the blade took, spacings
    Half halves_[2];
    std::optional<CutMask> mask_;
    std::optional<LatticeWarp> warp_;
    std::optional<DistanceVolume> volume_;
    std::optional<Raycaster> caster_;
};

// Of cells that end at the cut, each side needs the copies beyond: else its field goes on from each cell in
// another direction.
TEST_F(GlRaycastCut, FacesOfACutThroughNodesAreFlatAtRestHoweverTheHalvesBend) {
    for (const double beside : {-0.01, 0.01}) {
        SCOPED_TRACE(beside);
        plane_ = std::round(middle_.x) - middle_.x + beside;
        tilt_ = 0;
        normal_ = {1, 0, 0};
        mask_->clear();
        state_->upload(sim::restState(lattice_));
        mask_->paint(*state_, lattice_, stroke());
        sim::LatticeState now = cutAndOpened();
        for (std::size_t node = 0; node < lattice_.nodeCount(); ++node) {
            const glm::dvec3 from = lattice_.restPosition(node) - middle_;
            const double bend = 0.07 * (from.y * from.y + from.z * from.z) + 0.05 * from.x * from.y;
            now.positions[node] += glm::vec3(from.x > plane_ ? 4 - bend : bend - 4, 0, 0.5 * bend);
        }
        state_->upload(now);
        ASSERT_TRUE(warp_->update(*state_, &*mask_).ok());
        for (const double from : {-1.0, 1.0}) {
            int faces = 0, pits = 0;
            for (const RaycastProbe& found :
                 probe(view(glm::normalize(glm::dvec3(0.6 * from, -0.2, -0.8))), Solid::solid))
                if (found.kind == RaycastProbe::cutFace) {
                    ++faces;
                    pits += std::abs(side(lattice_.toLattice(found.rest))) > half_ + 0.1;
                }
            EXPECT_GT(faces, 200);
            EXPECT_LT(pits, 0.03 * faces) << pits << " of " << faces;
        }
    }
}

// A layer of nodes in the blade's very way, of which the springs and the rounded distance may say different
// things; and a layer that two strokes left alone, which falls. No cell hangs between the halves.
TEST_F(GlRaycastCut, NodesInTheBladesWayGoWhereTheirSpringsGo) {
    const double layer = std::round(middle_.x) - middle_.x;
    tilt_ = 0;
    normal_ = {1, 0, 0};
    for (Half& half : halves_)
        half.turn = glm::dmat3(1);
    for (const bool alone : {false, true})
        for (const double beside : {-0.04, 0.04}) {
            SCOPED_TRACE((alone ? "alone " : "with a half ") + std::to_string(beside));
            plane_ = layer + beside;
            mask_->clear();
            state_->upload(sim::restState(lattice_));
            mask_->paint(*state_, lattice_, stroke());
            plane_ = layer - beside;
            sim::LatticeState now = cutAndOpened();
            plane_ = layer + beside; // of the mask, which says where faces are
            if (alone) {
                sim::cutConnections(lattice_, sim::restState(lattice_).positions,
                                    toLattice(stroke(), lattice_), now.connections);
                for (std::size_t node = 0; node < lattice_.nodeCount(); ++node)
                    if (std::abs(lattice_.restPosition(node).x - middle_.x - layer) < 0.1)
                        now.positions[node] = glm::vec3(lattice_.restPosition(node)) - glm::vec3(0, 40, 0);
            }
            state_->upload(now);
            ASSERT_TRUE(warp_->update(*state_, &*mask_).ok());
            const View view = this->view(glm::normalize(glm::dvec3(0.3, -0.2, -0.8)));
            const std::vector<RaycastProbe> probes = probe(view, Solid::solid);
            int object = 0, gap = 0, wrong = 0;
            for (std::size_t i = 0; i < probes.size(); ++i) {
                glm::dvec3 from, along;
                ray(view, i, from, along);
                const bool any = meet(from, along).any;
                object += any;
                gap += !any;
                wrong += any != (probes[i].kind != RaycastProbe::nothing);
            }
            EXPECT_GT(object, 3000);
            EXPECT_GT(gap, 3000);
            EXPECT_LT(wrong, 0.006 * object) << wrong << " of " << object;
        }
}

// Solid: nothing between the halves, faces closed, where and as they must be.
TEST_F(GlRaycastCut, HalvesThatArePulledApartHaveClosedFacesAndNothingBetween) {
    cutAndOpen();
    int faces = 0, gap = 0;
    for (const glm::dvec3& direction : {glm::dvec3(0, 0, -1), {0.8, -0.2, -0.7}, {-0.75, 0.3, -0.7}}) {
        const View view = this->view(glm::normalize(direction));
        const std::vector<RaycastProbe> probes = probe(view, Solid::solid);
        int wrong = 0, object = 0, deep = 0, kinds = 0;
        std::vector<double> turned;
        for (std::size_t i = 0; i < probes.size(); ++i) {
            glm::dvec3 from, along;
            ray(view, i, from, along);
            const Met met = meet(from, along);
            const RaycastProbe& found = probes[i];
            object += met.any;
            gap += !met.any;
            wrong += met.any != (found.kind != RaycastProbe::nothing);
            if (!met.any || found.kind == RaycastProbe::nothing)
                continue;
            faces += met.face;
            kinds += met.face != (found.kind == RaycastProbe::cutFace);
            const glm::dvec3 rest = lattice_.toLattice(found.rest);
            const Half& half = halves_[side(rest) > 0 ? 0 : 1];
            const glm::dvec3 shown = half.turn * (rest - middle_) + middle_ + half.move;
            const double away = glm::dot(shown - from, along);
            EXPECT_LT(glm::distance(shown, from + away * along), 0.01) << "carried back to its ray";
            deep += std::abs(away - met.t) * kSpacing > kPixel;
            if (met.face)
                turned.push_back(std::acos(std::clamp(glm::dot(found.normal, met.normal), -1.0, 1.0)));
        }
        ASSERT_GT(object, 3000);
        EXPECT_LT(wrong, 0.006 * object) << wrong << " of " << object;
        EXPECT_LT(deep, 0.01 * object) << deep << " of " << object;
        EXPECT_LT(kinds, 0.01 * object) << kinds << " of " << object;
        std::sort(turned.begin(), turned.end());
        if (!turned.empty()) {
            EXPECT_LT(turned[turned.size() / 2] * 180 / std::numbers::pi, 2);
            EXPECT_LT(turned[turned.size() * 98 / 100] * 180 / std::numbers::pi, 8);
        }
    }
    EXPECT_GT(faces, 700);
}

// Of a side's tissue its texture ends some cells behind the cut: normals there are taken of what it holds.
TEST_F(GlRaycastCut, NormalsAreRightWhereASidesTissueEnds) {
    halves_[1].move = {-1.6, -9, -0.4}; // so far that its voxels are long
    cutAndOpen();
    int skin = 0, bent = 0;
    for (const glm::dvec3& direction : {glm::dvec3(0, 0, -1), {0.8, -0.2, -0.7}, {-0.75, 0.3, -0.7}}) {
        const View view = this->view(glm::normalize(direction));
        const std::vector<RaycastProbe> probes = probe(view, Solid::solid);
        for (std::size_t i = 0; i < probes.size(); ++i) {
            glm::dvec3 from, along;
            ray(view, i, from, along);
            const Met met = meet(from, along);
            const bool is = met.any && !met.face && probes[i].kind == RaycastProbe::surface;
            skin += is;
            bent += is && glm::dot(probes[i].normal, met.normal) < std::cos(0.35);
        }
    }
    EXPECT_GT(skin, 5000);
    EXPECT_LT(bent, 0.002 * skin) << bent << " of " << skin;
}

// The gap's width along a row through the middle, straight from the front of a cut without a turn.
TEST_F(GlRaycastCut, TheGapIsAsWideAsItMustBe) {
    halves_[0].turn = glm::dmat3(1);
    cutAndOpen();
    const View view = this->view({0, 0, -1});
    const std::vector<RaycastProbe> probes = probe(view, Solid::solid);
    for (const int row : {kRows / 2 - 12, kRows / 2, kRows / 2 + 9}) {
        int empty = 0, exact = 0;
        for (int x = kWidth / 4; x < 3 * kWidth / 4; ++x) {
            const auto i = std::size_t(row * kWidth + x);
            glm::dvec3 from, along;
            ray(view, i, from, along);
            exact += !meet(from, along).any;
            empty += probes[i].kind == RaycastProbe::nothing;
        }
        EXPECT_GT(exact, 5);
        EXPECT_NEAR(empty, exact, 1);
    }
}

// Hollow: only the ball's own surface is met, from without or within. A shell: faces within its thickness.
TEST_F(GlRaycastCut, AHollowBallHasNoFacesAndAShellOnlyThinOnes) {
    cutAndOpen();
    const View view = this->view(glm::normalize(glm::dvec3(0.8, -0.2, -0.7)));
    int within = 0, faces = 0, wrong = 0;
    for (const RaycastProbe& found : probe(view, Solid::hollow)) {
        if (found.kind == RaycastProbe::nothing)
            continue;
        EXPECT_NE(found.kind, RaycastProbe::cutFace);
        wrong += std::abs(glm::distance(lattice_.toLattice(found.rest), middle_) * kSpacing - kRadius) > 2e-4;
        within += found.kind == RaycastProbe::innerSide;
    }
    EXPECT_GT(within, 200);
    EXPECT_EQ(wrong, 0);
    const double voxel = volume_->grid().step;
    for (const RaycastProbe& found : probe(view, Solid::shell)) {
        if (found.kind != RaycastProbe::cutFace)
            continue;
        ++faces;
        const double depth = kRadius - glm::distance(lattice_.toLattice(found.rest), middle_) * kSpacing;
        EXPECT_GT(depth, -0.5 * voxel);
        EXPECT_LT(depth, kThickness + 0.5 * voxel);
    }
    EXPECT_GT(faces, 150);
}

// A cut that ends within the organ: beyond its end tissue is whole, and before anything opens it is where it
// was.
TEST_F(GlRaycastCut, WhereNothingOpensTheBallStaysABall) {
    sim::Stroke stroke;
    for (const int end : {0, 1}) {
        const double z = end ? 8 : -1;
        stroke.from[std::size_t(end)] = lattice_.toWorld(middle_ + glm::dvec3(kPlane, 1.3, z));
        stroke.to[std::size_t(end)] = lattice_.toWorld(middle_ + glm::dvec3(kPlane, -2.4, z));
    }
    mask_->paint(*state_, lattice_, stroke);
    sim::LatticeState now = sim::restState(lattice_);
    now.connections = lattice_.connections;
    sim::cutConnections(lattice_, now.positions, toLattice(stroke, lattice_), now.connections);
    state_->upload(now);
    ASSERT_TRUE(warp_->update(*state_, &*mask_).ok());
    const View view = this->view(glm::normalize(glm::dvec3(0.3, -0.2, -1)));
    int kerf = 0, wrong = 0;
    for (const RaycastProbe& found : probe(view, Solid::solid)) {
        if (found.kind == RaycastProbe::nothing)
            continue;
        const glm::dvec3 rest = lattice_.toLattice(found.rest) - middle_;
        const bool inCut = std::abs(rest.x - kPlane) < 0.3 && rest.y > -2.8 && rest.y < 1.7 && rest.z > -1.4;
        kerf += inCut;
        wrong += !inCut && std::abs(glm::length(rest) * kSpacing - kRadius) > 2e-4;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(kerf, 20);
    EXPECT_LT(kerf, 600);
}

// Drawn beside each other: the surface as trilinear mapping has it, and what is ray-cast through that map's
// inverse. Where the surface is met both have one depth, within half a voxel or within a pixel beside; the
// surface hides no face of a cut.
TEST_F(GlRaycastCut, TheSurfaceAndWhatIsRayCastAgreeToAPixel) {
    std::vector<SurfaceBinding> bindings = {bindSurface(lattice_, mesh_, sim::Mapping::trilinear)};
    auto passes = SurfacePasses::create(lattice_, mesh_, bindings, state_->layout());
    ASSERT_TRUE(passes.ok());
    for (const bool cut : {false, true}) {
        sim::LatticeState now =
            deformedState(lattice_, [&](const glm::dvec3& q) { return bend(q, middle_, 14.0); });
        if (cut) {
            ASSERT_TRUE(passes->openMask(lattice_, state_->layout()).ok());
            state_->upload(sim::restState(lattice_)); // as it was cut
            passes->mask()->paint(*state_, lattice_, stroke());
            mask_->paint(*state_, lattice_, stroke());
            now = cutAndOpened();
            bindings = {
                expressBinding(bindings[0], lattice_, mesh_, sim::Mapping::trilinear, now.connections)};
            const CutSurface left =
                cutSurface(lattice_, mesh_, bindings[0], bindings[0], now.connections, mask_->nodeSides());
            const std::vector<glm::uvec3> boundary = sim::boundaryLeft(lattice_, now.connections);
            ASSERT_TRUE(passes->show(left, lattice_, mesh_, bindings, boundary, state_->layout()).ok());
        }
        state_->upload(now);
        ASSERT_TRUE(warp_->update(*state_, cut ? &*mask_ : nullptr).ok());
        const View view = this->view(glm::normalize(glm::dvec3(0.7, -0.2, -0.7)));
        passes->follow(*state_, SurfaceStage::inCells);
        const Drawn surface([&] { passes->drawDepth(*state_, view.frame, SurfaceStage::inCells); }),
            cast([&] { EXPECT_TRUE(caster_->draw(view.frame, {}).ok()); });
        const std::vector<RaycastProbe> kinds = probe(view, Solid::solid);
        const double most = 0.5 * volume_->grid().step * cast.perMetre(view.camera);
        int met = 0, apart = 0, hidden = 0, faces = 0;
        for (int y = 1; y + 1 < kRows; ++y)
            for (int x = 1; x + 1 < kWidth; ++x) {
                const RaycastProbe& kind = kinds[std::size_t(y * kWidth + x)];
                const double depth = cast.at(x, y);
                faces += kind.kind == RaycastProbe::cutFace;
                double low = 1, high = 0; // of the surface, within a pixel
                bool all = true;
                for (int j = -1; j <= 1; ++j)
                    for (int i = -1; i <= 1; ++i) {
                        const double one = surface.at(x + i, y + j);
                        low = std::min(low, one);
                        high = one < 1 ? std::max(high, one) : high;
                        all = all && one < 1;
                    }
                const bool near = depth > low - most && depth < high + most;
                const bool before = all && high < depth - most;
                met += kind.kind == RaycastProbe::surface;
                apart += kind.kind == RaycastProbe::surface && !near;
                hidden += before;
            }
        EXPECT_GT(met, 2000);
        EXPECT_LT(apart, 0.002 * met) << apart << (cut ? ", cut" : "");
        EXPECT_LT(hidden, 0.002 * met) << hidden << (cut ? ", cut" : "");
        EXPECT_TRUE(!cut || faces > 300);
    }
}

} // namespace
} // namespace serosa::render
