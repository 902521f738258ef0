// The hybrid of CS07 section 6.3 (render/coarse_warp.h, render/ray_proxy.h): coarse maps by the vertex stage,
// textures in the pixel, against rays cast in double through the closed-form inverse of the same maps, and
// against pictures in which the pixel does all.
#include "models/phantom.h"
#include "render/deformation_chain.h"
#include "render/picture_target.h"
#include "render/raycast_measures.h"
#include "tests/gl_fixture.h"
#include "tests/render/ball_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace serosa::render {
namespace {

constexpr int kWidth = 84, kHeight = 63, kCells = 16;
const std::array<glm::dvec3, 2> kDirections = {glm::dvec3(-0.3, -0.7, -1), glm::dvec3(0.8, -0.5, 0.4)};

CoarseMap coarse(MapKind kind, double amount) {
    CoarseMap one;
    one.map = ballMap(kind);
    one.map.amount = amount;
    one.map.half = glm::dvec3(0.06);
    one.map.radius = 0.025; // of a pull: several cells
    one.mapping.objectFromLocal[3] = glm::dvec4(0.001, -0.002, 0.001, 1);
    return one;
}

CoarseWarp coarseOf(const std::vector<CoarseMap>& maps) {
    auto made = CoarseWarp::create(maps);
    EXPECT_TRUE(made.ok()) << made.error().message;
    return *made;
}

class GlRaycastHybrid : public test::GlTest {
protected:
    void SetUp() override {
        test::GlTest::SetUp();
        auto mesh = models::makePhantom("ball", 8000);
        ASSERT_TRUE(mesh);
        for (glm::dvec3& p : mesh->positions)
            p = 0.04 * glm::normalize(p);
        mesh_ = *mesh;
        auto made =
            DistanceVolume::create(mesh_, VolumeGrid::around(mesh_.lowest(), mesh_.highest(), 48, 3), 0.012);
        ASSERT_TRUE(made.ok()) << made.error().message;
        field_.emplace(std::move(*made));
    }
    Raycaster caster(const std::optional<Warp>& warp) const {
        auto made = Raycaster::create(space_, *field_);
        EXPECT_TRUE(made.ok());
        made->setWarp(warp);
        return std::move(*made);
    }
    RaycastView view(std::size_t k, int width = kWidth, int height = kHeight) const {
        return RaycastView::of(space_, 1.15 * mesh_.lowest(), 1.15 * mesh_.highest(), kDirections[k],
                               k % 2 ? sim::Projection::orthographic : sim::Projection::perspective, width,
                               height);
    }
    static std::vector<RaycastProbe> probe(Raycaster& caster, const RaycastView& view,
                                           const RaycastLook& look) {
        auto made = caster.probe(view.frame, look, view.width, view.height);
        EXPECT_TRUE(made.ok()) << made.error().message;
        return *made;
    }
    /// With the twin as the reference.
    RaycastAgreement agreement(Raycaster& hybrid, const CoarseWarp& warp, const Warp& fine,
                               const RaycastLook& look, std::size_t views = kDirections.size()) const {
        RaycastTwin twin(field_->read(), field_->grid(), fine, look.solid, look.thickness,
                         field_->grid().step / 6);
        twin.setCoarse(&warp);
        RaycastAgreement sum;
        for (std::size_t k = 0; k < views; ++k)
            addAgreement(sum, view(k), hybrid, probe(hybrid, view(k), look), twin);
        return sum;
    }

    sim::TriangleMesh mesh_;
    sim::Lattice space_ = objectSpace(0.0046);
    std::optional<DistanceVolume> field_;
};

struct Case {
    const char* name;
    Solid solid;
    MapKind coarse;
    double amount;
    MapKind fine;
    Search search;
};

class GlRaycastHybridTwin : public GlRaycastHybrid, public ::testing::WithParamInterface<Case> {};

TEST_P(GlRaycastHybridTwin, ShowsWhatTheClosedFormShows) {
    const Case& tested = GetParam();
    const auto texture = DeformationTexture::bake(ballMap(tested.fine), glm::ivec3(48), TexelFormat::half);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    const Warp fine{&*texture, {}};
    const CoarseWarp warp = coarseOf({coarse(tested.coarse, tested.amount)});
    Raycaster hybrid = caster(fine);
    hybrid.setCoarse(warp, kCells);
    RaycastLook look;
    look.solid = tested.solid;
    look.search = tested.search;
    const RaycastAgreement sum = agreement(hybrid, warp, fine, look);
    RecordProperty("silhouettes", std::to_string(100 * sum.silhouetteShare()));
    RecordProperty("deep", std::to_string(100 * sum.deepShare()));
    RecordProperty("turned", std::to_string(sum.medianTurn()));
    EXPECT_GT(sum.object, 1500);
    EXPECT_LT(sum.silhouetteShare(), 0.005) << sum.silhouettes << " of " << sum.object;
    EXPECT_LT(sum.deepShare(), 0.01) << sum.deep << " of " << sum.both;
    EXPECT_LT(sum.medianTurn(), 0.5); // deg; 2 were asked, 1.5 have facets
    if (texture->cuts() && tested.solid != Solid::hollow) {
        EXPECT_GT(sum.faces, 20) << "cut faces are seen";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Modes, GlRaycastHybridTwin,
    ::testing::Values(
        Case{"bendKnifeSolid", Solid::solid, MapKind::bend, 0.9, MapKind::knife, Search::jacobian},
        Case{"bendKnifeShell", Solid::shell, MapKind::bend, 0.9, MapKind::knife, Search::jacobian},
        Case{"bendKnifeHollow", Solid::hollow, MapKind::bend, 0.9, MapKind::knife, Search::jacobian},
        Case{"twistPullSolid", Solid::solid, MapKind::twist, 0.9, MapKind::pull, Search::jacobian},
        Case{"twistPullHollow", Solid::hollow, MapKind::twist, 0.9, MapKind::pull, Search::linear},
        Case{"twistPullShell", Solid::shell, MapKind::twist, 0.9, MapKind::pull, Search::threshold},
        Case{"waveKnifeShell", Solid::shell, MapKind::wave, 0.003, MapKind::knife, Search::linear},
        Case{"pullSeamSolid", Solid::solid, MapKind::pull, 0.02, MapKind::seam, Search::jacobian}),
    [](const auto& tested) { return std::string(tested.param.name); });

// Between corners the bent map is followed to second order: half of the tetrahedra's size, a quarter of what
// a place is off by.
TEST_F(GlRaycastHybrid, ErrorsFallWithTheSquareOfTheSize) {
    const CoarseWarp warp = coarseOf({coarse(MapKind::bend, 0.9), coarse(MapKind::twist, 0.5)});
    std::vector<double> off;
    for (const int cells : {8, 16, 32}) {
        Raycaster hybrid = caster(std::nullopt);
        hybrid.setCoarse(warp, cells);
        const RaycastView seen = view(0);
        std::vector<double> apart;
        const auto probes = probe(hybrid, seen, {});
        for (std::size_t i = 0; i < probes.size(); ++i) {
            if (probes[i].kind != RaycastProbe::surface)
                continue;
            const RaycastView::Ray ray = seen.ray(i);
            const glm::dvec3 shown = ray.from + seen.distanceOf(hybrid, ray, probes[i]) * ray.along;
            apart.push_back(glm::distance(warp.back(shown), probes[i].rest));
        }
        ASSERT_GT(apart.size(), 700U);
        std::nth_element(apart.begin(), apart.begin() + std::ptrdiff_t(apart.size() / 2), apart.end());
        off.push_back(apart[apart.size() / 2]);
    }
    EXPECT_LT(off[2], 6e-5);
    EXPECT_NEAR(off[0] / off[1], 4, 1);
    EXPECT_NEAR(off[1] / off[2], 4, 1);
    RecordProperty("off",
                   std::to_string(off[0]) + " " + std::to_string(off[1]) + " " + std::to_string(off[2]));
}

// The same deformations as one texture, each sample of a ray taken through all of them.
TEST_F(GlRaycastHybrid, ShowsWhatThePixelAloneShows) {
    const auto knife = DeformationTexture::bake(ballMap(MapKind::knife), glm::ivec3(64), TexelFormat::single);
    CoarseMap bend = coarse(MapKind::bend, 0.6);
    bend.map.half = glm::dvec3(0.07); // holds the bent ball
    const auto bent = DeformationTexture::bake(bend.map, {128, 128, 1}, TexelFormat::single);
    ASSERT_TRUE(knife.ok() && bent.ok());
    const Warp fine{&*knife, {}};
    const auto chained = chain({fine, Warp{&*bent, bend.mapping}}, TexelFormat::single);
    ASSERT_TRUE(chained.ok()) << chained.error().message;
    Raycaster pixel = caster(Warp{&chained->texture, chained->mapping}), hybrid = caster(fine);
    hybrid.setCoarse(coarseOf({bend}), kCells);
    for (const Solid solid : {Solid::hollow, Solid::solid, Solid::shell}) {
        RaycastLook look;
        look.solid = solid;
        const RaycastView seen = view(0, 96, 72);
        const auto ones = probe(hybrid, seen, look), others = probe(pixel, seen, look);
        RaycastAgreement sum;
        addAgreement(sum, ones, others, 0.5 * seen.footprint(glm::dvec3(0)));
        EXPECT_GT(sum.object, 900);
        EXPECT_LT(sum.silhouetteShare(), 0.005) << sum.silhouettes << " of " << sum.object;
        EXPECT_LT(sum.deepShare(), 0.01) << sum.deep << " of " << sum.both;
        EXPECT_LT(sum.medianTurn(), 0.5); // deg; 2 were asked, 1.5 have facets
        RecordProperty("silhouettes" + std::to_string(int(solid)),
                       std::to_string(100 * sum.silhouetteShare()));
        RecordProperty("deep" + std::to_string(int(solid)), std::to_string(100 * sum.deepShare()));
        RecordProperty("turned" + std::to_string(int(solid)), std::to_string(sum.medianTurn()));
    }
}

/// sRGB of a picture over black.
Image pictureOf(Raycaster& caster, const RaycastView& view, const RaycastLook& look) {
    const PictureTarget target(view.width, view.height);
    target.begin();
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const Status drawn = caster.draw(view.frame, look);
    EXPECT_TRUE(drawn.ok()) << drawn.error().message;
    target.end();
    return target.read();
}

// A twist by next to nothing leaves the ball where it is, and its tetrahedra around it: neither lines along
// their faces, nor gaps, nor facets in its shading, at one ray a pixel and at several.
TEST_F(GlRaycastHybrid, TetrahedraAreNotSeen) {
    const auto knife = DeformationTexture::bake(ballMap(MapKind::knife), glm::ivec3(48), TexelFormat::half);
    ASSERT_TRUE(knife.ok());
    for (const auto& [solid, antialias] : {std::pair(Solid::hollow, false), std::pair(Solid::solid, false),
                                           std::pair(Solid::shell, false), std::pair(Solid::solid, true)}) {
        RaycastLook look;
        look.solid = solid;
        look.antialias = antialias;
        Raycaster pixel = caster(Warp{&*knife, {}}), hybrid = caster(Warp{&*knife, {}});
        hybrid.setCoarse(coarseOf({coarse(MapKind::twist, 1e-5)}), 11);
        const RaycastView seen = view(0, antialias ? 64 : 128, antialias ? 48 : 96);
        const Image one = pictureOf(hybrid, seen, look), other = pictureOf(pixel, seen, look);
        int lit = 0, off = 0;
        for (std::size_t i = 0; i < one.rgb.size(); ++i) {
            lit += other.rgb[i] > 40;
            off += std::abs(int(one.rgb[i]) - int(other.rgb[i])) > 12;
        }
        EXPECT_GT(lit, 1000);
        EXPECT_LE(off, lit / (antialias ? 30 : 200))
            << "of " << lit << ", solid " << int(solid); // at outlines
        RecordProperty("off" + std::to_string(int(solid)) + std::to_string(antialias),
                       std::to_string(off) + "/" + std::to_string(lit));
    }
}

// Which tetrahedra are left out does not show.
TEST_F(GlRaycastHybrid, WhatIsLeftOutHoldsNothing) {
    for (const MapKind kind : {MapKind::knife, MapKind::peel, MapKind::pull, MapKind::sphere}) {
        DeformationMap map = ballMap(kind);
        map.radius = kind == MapKind::sphere ? 0.022 : map.radius;
        const auto texture = DeformationTexture::bake(map, glm::ivec3(48), TexelFormat::half);
        ASSERT_TRUE(texture.ok());
        Warp fine{&*texture, {}};
        fine.mapping.objectFromLocal[3] = glm::dvec4(0, kind == MapKind::sphere ? 0.025 : 0, 0, 1);
        for (const Solid solid : {Solid::hollow, Solid::solid, Solid::shell}) {
            if ((kind == MapKind::pull) != (solid == Solid::hollow) ||
                (solid == Solid::shell && kind != MapKind::knife)) // each where it says most
                continue;
            RaycastLook look;
            look.solid = solid;
            Raycaster hybrid = caster(fine);
            hybrid.setCoarse(coarseOf({coarse(MapKind::bend, 0.9)}), 8);
            const RaycastView seen = view(0, 60, 45);
            const auto left = probe(hybrid, seen, look);
            look.skipField = false;
            const auto all = probe(hybrid, seen, look);
            RaycastAgreement sum;
            addAgreement(sum, left, all, 0.25 * field_->grid().step);
            EXPECT_GT(sum.object, 250);
            EXPECT_LE(sum.silhouettes + sum.deep, 3) // graze: samples lie elsewhere
                << nameOf(kind) << ", solid " << int(solid) << ": " << sum.silhouettes << ", " << sum.deep;
        }
    }
}

TEST(CoarseWarp, GoesThereAndBack) {
    const CoarseWarp warp = coarseOf({coarse(MapKind::pull, 0.02), coarse(MapKind::twist, 1.1),
                                      coarse(MapKind::wave, 0.004), coarse(MapKind::bend, -0.7)});
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 p = 0.045 * glm::dvec3(std::sin(i * 1.3), std::sin(i * 2.1 + 1), std::cos(i * 0.7)),
                         shown = warp.forward(p);
        EXPECT_LT(glm::distance(warp.back(shown), p), 1e-9);
        const glm::dmat3 both = warp.backJacobian(shown) * warp.jacobian(p);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_LT(glm::distance(both[axis], glm::dmat3(1)[axis]), 2e-3) << i;
    }
}

TEST(CoarseWarp, RefusesWhatItCannotDo) {
    const auto message = [](const std::vector<CoarseMap>& maps) {
        const auto made = CoarseWarp::create(maps);
        return made.ok() ? std::string() : made.error().message;
    };
    EXPECT_NE(message({}).find("take 1 to 4"), std::string::npos);
    EXPECT_NE(message(std::vector<CoarseMap>(5, coarse(MapKind::bend, 0.5))).find("take 1 to 4"),
              std::string::npos);
    EXPECT_NE(message({coarse(MapKind::knife, 0.008)}).find("only twist"), std::string::npos);
    CoarseMap wound = coarse(MapKind::bend, 0.5);
    wound.mapping.cylinderRadius = 0.02;
    EXPECT_NE(message({wound}).find("wound"), std::string::npos);
    EXPECT_NE(message({coarse(MapKind::bend, 5)}).find("270 degrees"), std::string::npos);
    CoarseMap sharp = coarse(MapKind::bend, 1.5);
    sharp.map.extent = 0.03; // its centre lies within the ball
    EXPECT_TRUE(coarseOf({sharp}).foldsAt({glm::dvec3(0), glm::dvec3(0.038, 0, 0)}).has_value());
    EXPECT_FALSE(coarseOf({sharp}).foldsAt({glm::dvec3(0), glm::dvec3(-0.038, 0, 0)}).has_value());
}

} // namespace
} // namespace serosa::render
