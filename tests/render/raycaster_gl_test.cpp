// The deformation shader: what is known in closed form, and its twin in double with dense samples.
#include "models/phantom.h"
#include "render/depth_maps.h"
#include "render/picture_target.h"
#include "render/raycast_measures.h"
#include "render/raycast_twin.h"
#include "render/raycaster.h"
#include "tests/gl_fixture.h"
#include "tests/render/ball_maps.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace serosa::render {
namespace {

constexpr int kWidth = 96, kHeight = 72;

class GlRaycaster : public test::GlTest {
protected:
    /// A ball of radius 40 mm about the origin, m.
    static sim::TriangleMesh ball() {
        auto mesh = models::makePhantom("ball", 8000);
        EXPECT_TRUE(mesh);
        for (glm::dvec3& p : mesh->positions)
            p = 0.04 * glm::normalize(p);
        return *mesh;
    }
    static DistanceVolume volumeOf(const sim::TriangleMesh& mesh, int samples = 48, double band = 0.012) {
        auto made =
            DistanceVolume::create(mesh, VolumeGrid::around(mesh.lowest(), mesh.highest(), samples, 3), band);
        EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
        return std::move(*made);
    }
    /// Pictures of an orthographic or perspective view of the box of a mesh.
    struct View {
        sim::Lattice lattice = test::blockLattice(2, 2, 2, 0.004);
        CameraView camera;
        Frame frame;
        View(const sim::TriangleMesh& mesh, const glm::dvec3& direction, sim::Projection projection) {
            sim::Camera settings;
            settings.projection = projection;
            settings.direction = direction;
            camera =
                makeCamera(settings, 1.3 * mesh.lowest(), 1.3 * mesh.highest(), double(kWidth) / kHeight);
            frame = makeFrame(lattice, camera, {}, {}, kWidth, kHeight);
        }
        /// Of pixel i of the probe, top row first; unit.
        void ray(std::size_t i, glm::dvec3& from, glm::dvec3& along) const {
            const double x = 2 * (double(i % kWidth) + 0.5) / kWidth - 1,
                         y = 1 - 2 * (double(i / kWidth) + 0.5) / kHeight;
            const glm::dmat4 worldFromClip = glm::inverse(camera.clipFromCamera * camera.cameraFromWorld);
            const auto at = [&](double depth) {
                const glm::dvec4 p = worldFromClip * glm::dvec4(x, y, depth, 1);
                return glm::dvec3(p) / p.w;
            };
            from = at(-1);
            along = glm::normalize(at(1) - from);
        }
        /// Width of a pixel at a place, m.
        double footprint(const glm::dvec3& at) const {
            const bool orthographic = camera.clipFromCamera[2][3] == 0;
            const double away = orthographic ? 1 : glm::distance(at, camera.eye);
            return 2 * away / (camera.clipFromCamera[1][1] * kHeight);
        }
    };
};

TEST_F(GlRaycaster, AnUndeformedBallIsABall) {
    const sim::TriangleMesh mesh = ball();
    const DistanceVolume volume = volumeOf(mesh, 64);
    for (const Solid solid : {Solid::hollow, Solid::solid, Solid::shell})
        for (const auto projection : {sim::Projection::perspective, sim::Projection::orthographic}) {
            const View view(mesh, {0.3, -0.4, -1}, projection);
            auto caster = Raycaster::create(view.lattice, volume);
            ASSERT_TRUE(caster.ok());
            RaycastLook look;
            look.solid = solid;
            const auto probes = caster->probe(view.frame, look, kWidth, kHeight);
            ASSERT_TRUE(probes.ok()) << probes.error().message;
            int hits = 0, wrong = 0;
            for (std::size_t i = 0; i < probes->size(); ++i) {
                const RaycastProbe& probe = (*probes)[i];
                glm::dvec3 from, along;
                view.ray(i, from, along);
                const double middle = -glm::dot(from, along), miss = glm::length(from + middle * along);
                if (std::abs(miss - 0.04) < 0.0006) // the mesh is a polyhedron
                    continue;
                hits += miss < 0.04;
                wrong += (probe.kind == RaycastProbe::surface) != (miss < 0.04);
                if (probe.kind != RaycastProbe::surface)
                    continue;
                EXPECT_NEAR(glm::length(probe.rest), 0.04, 0.0003);
                EXPECT_GT(glm::dot(probe.normal, glm::normalize(probe.rest)), std::cos(0.04));
                EXPECT_LT(glm::length(glm::cross(probe.rest - from, along)), 2e-5) << "on its ray";
            }
            EXPECT_EQ(wrong, 0);
            EXPECT_GT(hits, 700);
        }
}

// A ball that is sheared by a linear displacement: an ellipsoid with a known silhouette.
// However short the steps, a ray goes on to its end.
TEST_F(GlRaycaster, ShortStepsReachTheFarSide) {
    const sim::TriangleMesh mesh = ball();
    const DistanceVolume volume = volumeOf(mesh, 64);
    const View view(mesh, {0.3, -0.4, -1}, sim::Projection::perspective);
    auto caster = Raycaster::create(view.lattice, volume);
    ASSERT_TRUE(caster.ok());
    RaycastLook look;
    look.skipField = false;
    look.search = Search::linear;
    look.coarse = 0;
    look.step = 0.01;
    const auto probes = caster->probe(view.frame, look, kWidth, kHeight);
    ASSERT_TRUE(probes.ok()) << probes.error().message;
    int wrong = 0, far = 0;
    for (std::size_t i = 0; i < probes->size(); ++i) {
        glm::dvec3 from, along;
        view.ray(i, from, along);
        const double middle = -glm::dot(from, along), miss = glm::length(from + middle * along);
        if (std::abs(miss - 0.04) > 0.0006)
            wrong += ((*probes)[i].kind == RaycastProbe::surface) != (miss < 0.04);
        far += (*probes)[i].samples > 2048;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(far, 300);
}

TEST_F(GlRaycaster, AShearedBallHasItsKnownSilhouette) {
    const sim::TriangleMesh mesh = ball();
    const DistanceVolume volume = volumeOf(mesh, 64);
    // x' = x + 0.3 y: D = (-0.3 y', 0, 0), constant along x and z: 1 x 32 x 1 texels.
    std::vector<glm::dvec4> texels;
    for (int i = 0; i < 32; ++i)
        texels.emplace_back(-0.3 * ((i + 0.5) / 32 * 0.2 - 0.1), 0, 0, 1);
    const auto texture = DeformationTexture::create({1, 32, 1}, glm::dvec3(0.1), TexelFormat::single, texels);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    const View view(mesh, {0, 0, -1}, sim::Projection::orthographic);
    auto caster = Raycaster::create(view.lattice, volume);
    ASSERT_TRUE(caster.ok());
    caster->setWarp(Warp{&*texture, {}});
    const auto probes = caster->probe(view.frame, {}, kWidth, kHeight);
    ASSERT_TRUE(probes.ok()) << probes.error().message;
    int wrong = 0, inside = 0;
    for (std::size_t i = 0; i < probes->size(); ++i) {
        glm::dvec3 from, along;
        view.ray(i, from, along);
        const double r = std::hypot(from.x - 0.3 * from.y, from.y);
        if (std::abs(r - 0.04) < 0.0006)
            continue;
        inside += r < 0.04;
        wrong += ((*probes)[i].kind == RaycastProbe::surface) != (r < 0.04);
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(inside, 700);
}

/// Linear red of a picture over black.
std::vector<double> linearRed(Raycaster& caster, const RaycastView& view, bool antialias) {
    const PictureTarget target(view.width, view.height);
    target.begin();
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    RaycastLook look;
    look.antialias = antialias;
    const Status drawn = caster.draw(view.frame, look);
    EXPECT_TRUE(drawn.ok()) << drawn.error().message;
    target.end();
    const Image image = target.read();
    std::vector<double> red;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        const double s = image.rgb[i] / 255.0;
        red.push_back(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    return red;
}

// What a pixel at the edge should show is the mean of many smaller ones.
void aRayASampleSmoothsTheEdges(const sim::TriangleMesh& mesh, const RayField& field) {
    constexpr int kFine = 8, kSmall = 40;
    const sim::Lattice space = objectSpace(0.004);
    auto caster = Raycaster::create(space, field);
    ASSERT_TRUE(caster.ok());
    const auto view = [&](int size) {
        return RaycastView::of(space, mesh.lowest(), mesh.highest(), {0.2, -0.3, -1},
                               sim::Projection::perspective, size, size);
    };
    const auto fine = linearRed(*caster, view(kFine * kSmall), false),
               plain = linearRed(*caster, view(kSmall), false),
               smooth = linearRed(*caster, view(kSmall), true);
    double offPlain = 0, offSmooth = 0;
    int edges = 0;
    for (int y = 0; y < kSmall; ++y)
        for (int x = 0; x < kSmall; ++x) {
            double sum = 0;
            int dark = 0;
            for (int k = 0; k < kFine * kFine; ++k) {
                const double red =
                    fine[std::size_t((y * kFine + k / kFine) * kFine * kSmall + x * kFine + k % kFine)];
                sum += red;
                dark += red < 0.005;
            }
            if (dark == 0 || dark == kFine * kFine)
                continue;
            ++edges;
            const auto i = std::size_t(y * kSmall + x);
            offPlain += std::abs(plain[i] - sum / (kFine * kFine));
            offSmooth += std::abs(smooth[i] - sum / (kFine * kFine));
        }
    EXPECT_GT(edges, 80);
    EXPECT_LT(offSmooth, 0.5 * offPlain) << "over " << edges << " pixels";
}

TEST_F(GlRaycaster, ARayASampleSmoothsTheEdges) {
    const sim::TriangleMesh mesh = ball();
    const DistanceVolume volume = volumeOf(mesh, 40);
    aRayASampleSmoothsTheEdges(mesh, RayField::of(volume));
}

TEST_F(GlRaycaster, ARayASampleSmoothsTheEdgesOfDepthMaps) {
    const sim::TriangleMesh mesh = ball();
    const auto maps = DepthMaps::create(mesh, VolumeGrid::around(mesh.lowest(), mesh.highest(), 40, 3),
                                        {FieldKind::depthCube, 0});
    ASSERT_TRUE(maps.ok()) << maps.error().message;
    aRayASampleSmoothsTheEdges(mesh, maps->field());
}

struct Case {
    const char* name;
    Solid solid;
    MapKind kind;
    bool wound;
};

class GlRaycasterTwin : public GlRaycaster, public ::testing::WithParamInterface<Case> {};

TEST_P(GlRaycasterTwin, AgreesOnRandomViews) {
    const Case& tested = GetParam();
    const sim::TriangleMesh mesh = ball();
    const DistanceVolume volume = volumeOf(mesh);
    const auto texture = DeformationTexture::bake(ballMap(tested.kind), glm::ivec3(48), TexelFormat::half);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    Warp warp{&*texture, {}};
    warp.mapping.objectFromLocal = glm::dmat4(1.02);
    warp.mapping.objectFromLocal[3] = glm::dvec4(0.002, 0.001, -0.003, 1);
    if (tested.wound)
        warp.mapping.cylinderRadius = 0.02;
    RaycastLook look;
    look.solid = tested.solid;
    look.search = Search::jacobian;
    const double voxel = volume.grid().step;
    const RaycastTwin twin(volume.read(), volume.grid(), warp, look.solid, look.thickness, voxel / 10);
    std::mt19937 engine(11);
    const auto number = [&] { return 2.0 * double(engine()) / 4294967296.0 - 1.0; };
    int silhouettes = 0, object = 0, deep = 0, both = 0, faces = 0;
    std::vector<double> turned;
    for (int k = 0; k < 3; ++k) {
        const double x = number(), y = number();
        const View view(mesh, glm::normalize(glm::dvec3(x, y - 0.6, -0.8)),
                        k % 2 ? sim::Projection::orthographic : sim::Projection::perspective);
        auto caster = Raycaster::create(view.lattice, volume);
        ASSERT_TRUE(caster.ok());
        caster->setWarp(warp);
        const auto probes = caster->probe(view.frame, look, kWidth, kHeight);
        ASSERT_TRUE(probes.ok()) << probes.error().message;
        for (std::size_t i = 0; i < probes->size(); ++i) {
            glm::dvec3 from, along;
            view.ray(i, from, along);
            const glm::dvec3 one = (caster->lowest() - from) / along,
                             two = (caster->highest() - from) / along, near = glm::min(one, two),
                             far = glm::max(one, two);
            const double start = std::max({near.x, near.y, near.z, 0.0}),
                         end = std::min({far.x, far.y, far.z});
            const RaycastProbe exact = start < end ? twin.cast(from, along, start, end) : RaycastProbe();
            const RaycastProbe& probe = (*probes)[i];
            object += exact.kind != RaycastProbe::nothing;
            silhouettes += (exact.kind != 0) != (probe.kind != 0);
            faces += exact.kind == RaycastProbe::cutFace;
            if (exact.kind == 0 || probe.kind == 0)
                continue;
            ++both;
            const glm::dvec3 at = from + exact.t * along;
            // The probe's t is from the eye, or from a place of its own: compare at rest and along the ray.
            const double t = view.camera.clipFromCamera[2][3] != 0
                                 ? probe.t - glm::distance(view.camera.eye, from)
                                 : exact.t + glm::dot(probe.rest - exact.rest, along);
            deep += std::abs(t - exact.t) > 0.5 * view.footprint(at);
            turned.push_back(std::acos(std::clamp(glm::dot(probe.normal, exact.normal), -1.0, 1.0)) * 180 /
                             std::numbers::pi);
        }
    }
    ASSERT_GT(object, 2500);
    std::sort(turned.begin(), turned.end());
    EXPECT_LT(double(silhouettes) / object, 0.005) << silhouettes << " of " << object;
    EXPECT_LT(double(deep) / both, 0.01) << deep << " of " << both;
    EXPECT_LT(turned[turned.size() / 2], 2.0);
    if (texture->cuts() && tested.solid != Solid::hollow) {
        EXPECT_GT(faces, 20) << "cut faces are seen";
    }
}

INSTANTIATE_TEST_SUITE_P(Modes, GlRaycasterTwin,
                         ::testing::Values(Case{"twist", Solid::solid, MapKind::twist, false},
                                           Case{"bendHollow", Solid::hollow, MapKind::bend, false},
                                           Case{"pull", Solid::solid, MapKind::pull, false},
                                           Case{"waveShell", Solid::shell, MapKind::wave, false},
                                           Case{"peelSolid", Solid::solid, MapKind::peel, false},
                                           Case{"peelShell", Solid::shell, MapKind::peel, false},
                                           Case{"knifeHollow", Solid::hollow, MapKind::knife, false},
                                           Case{"knifeSolid", Solid::solid, MapKind::knife, false},
                                           Case{"knifeShell", Solid::shell, MapKind::knife, false},
                                           Case{"knifeRound", Solid::solid, MapKind::knife, true},
                                           Case{"seamHollow", Solid::hollow, MapKind::seam, false}),
                         [](const auto& tested) { return std::string(tested.param.name); });

} // namespace
} // namespace serosa::render
