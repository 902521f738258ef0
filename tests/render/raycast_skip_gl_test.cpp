// Empty-space skipping: its bounds are bounds, and pictures with and without it show the same.
#include "models/phantom.h"
#include "render/raycast_measures.h"
#include "render/raycast_skip.h"
#include "tests/gl_fixture.h"
#include "tests/render/ball_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace serosa::render {
namespace {

constexpr double kRadius = 0.04; // m

/// Of a ball. \param band m: exact to here
Result<DistanceVolume> ballVolume(int samples, double band) {
    auto mesh = models::makePhantom("ball", 8000);
    if (!mesh)
        return mesh.error();
    for (glm::dvec3& p : mesh->positions)
        p = kRadius * glm::normalize(p);
    return DistanceVolume::create(*mesh, VolumeGrid::around(mesh->lowest(), mesh->highest(), samples, 3),
                                  band);
}

TEST(Stretch, IsThatOfScalesAndTurns) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    const glm::dmat3 turn(c, s, 0, -s, c, 0, 0, 0, 1), scale(2, 0, 0, 0, 0.5, 0, 0, 0, 1);
    EXPECT_NEAR(largestStretch(turn), 1, 1e-12);
    EXPECT_NEAR(largestStretch(turn * scale), 2, 1e-12);
    EXPECT_NEAR(leastStretch(scale * turn), 0.5, 1e-12);
    // A shear by k: the golden one of k = 1 stretches by the golden ratio.
    EXPECT_NEAR(largestStretch(glm::dmat3(1, 0, 0, 1, 1, 0, 0, 0, 1)), std::numbers::phi, 1e-9);
}

/// Nothing kept lies within the way that a place says, and no two places within reach move apart by more than
/// the bound.
TEST(RaycastSkip, BoundsHold) {
    std::mt19937 engine(5);
    const auto number = [&] { return 2.0 * double(engine()) / 4294967296.0 - 1.0; };
    for (const MapKind kind : {MapKind::twist, MapKind::pull, MapKind::knife, MapKind::peel})
        for (const double radius : {0.0, 0.08}) {
            SCOPED_TRACE(std::string(nameOf(kind)) + (radius > 0 ? ", wound" : ""));
            const auto texture = DeformationTexture::bake(ballMap(kind), {40, 32, 24}, TexelFormat::single);
            ASSERT_TRUE(texture.ok()) << texture.error().message;
            const RaycastSkip skip = RaycastSkip::of(*texture, radius);
            const auto nearest = [&](const glm::dvec3& at) { // as the shader reads it
                const glm::ivec3 size = texture->size(),
                                 i = glm::clamp(
                                     glm::ivec3(glm::floor((at + texture->half()) / texture->texelSize())),
                                     glm::ivec3(0), size - 1);
                return skip.texels[std::size_t(i.x + size.x * (i.y + size.y * i.z))];
            };
            TextureMapping mapping;
            mapping.cylinderRadius = radius;
            const glm::dvec3 half = texture->half();
            const auto inside = [&](const glm::dvec3& q) {
                return std::max({std::abs(q.x) - half.x, std::abs(q.y) - half.y, std::abs(q.z) - half.z}) < 0;
            };
            int moved = 0, steep = 0, cut = 0;
            for (int k = 0; k < 4000; ++k) {
                glm::dvec3 at, way;
                for (int axis = 0; axis < 3; ++axis) {
                    at[axis] = half[axis] * number();
                    way[axis] = number();
                }
                way = glm::normalize(way);
                const glm::dvec4 here = texture->sample(at);
                const glm::vec3 known = nearest(at);
                // A short way along which the bound must hold, as it must at each place within reach.
                const bool wide = k % 2;
                const glm::dvec3 near =
                                     at + 0.5 * (number() + 1) * (wide ? skip.reach : skip.nearReach) * way,
                                 by = 1e-5 * way;
                if (inside(near) && inside(near + by)) {
                    const auto rest = [&](const glm::dvec3& q) {
                        return mapping.toObject(q + glm::dvec3(texture->sample(q)));
                    };
                    const double share = glm::distance(rest(near + by), rest(near)) /
                                         glm::distance(mapping.toObject(near + by), mapping.toObject(near)),
                                 bound = wide ? known.y : known.x;
                    EXPECT_LE(share, 1.02 * bound) << (wide ? "within reach" : "near");
                    steep += share > 0.3 * bound;
                    ++moved;
                }
                if (here.w < 0.5) {
                    ++cut;
                    const double free = std::max(double(known.z), (0.5 - here.w) / skip.maskSlope);
                    const glm::dvec3 to = at + 0.5 * (number() + 1) * free * way;
                    EXPECT_TRUE(!inside(to) || texture->sample(to).w < 0.5 + 1e-6);
                }
            }
            EXPECT_GT(moved, 1000);
            EXPECT_GT(steep, 100) << "a bound that is worth something";
            EXPECT_EQ(cut > 20, texture->cuts());
        }
}

struct Case {
    const char* name;
    MapKind kind;
    Solid solid;
    Search search;
    double wound = 0;
};

class GlRaycastSkipTight : public test::GlTest {};

// A ball that is shown smaller in all directions: what the bound says is how far its wall is. The wall is so
// thin that whoever goes on by more comes out behind it.
TEST_F(GlRaycastSkipTight, AThinWallIsNotOverrun) {
    const auto volume = ballVolume(64, 0.006);
    ASSERT_TRUE(volume.ok()) << volume.error().message;
    const double half = 0.06, shrinks = 1.6;
    std::vector<glm::dvec4> texels;
    for (int z = 0; z < 16; ++z)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                texels.emplace_back((shrinks - 1) * half * (glm::dvec3(x, y, z) - 7.5) / 8.0, 1);
    const auto texture =
        DeformationTexture::create(glm::ivec3(16), glm::dvec3(half), TexelFormat::single, texels);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    const sim::Lattice space = objectSpace(0.004);
    auto caster = Raycaster::create(space, *volume);
    ASSERT_TRUE(caster.ok());
    caster->setWarp(Warp{&*texture, {}});
    const RaycastView view = RaycastView::of(space, 0.8 * glm::dvec3(-kRadius), 0.8 * glm::dvec3(kRadius),
                                             {-0.3, -0.8, -0.6}, sim::Projection::perspective, 96, 96);
    for (const Search search : {Search::linear, Search::jacobian}) {
        RaycastLook look;
        look.solid = Solid::shell;
        look.thickness = 1.5 * volume->grid().step;
        look.search = search;
        const auto probes = caster->probe(view.frame, look, view.width, view.height);
        ASSERT_TRUE(probes.ok()) << probes.error().message;
        int outside = 0, inner = 0;
        double off = 0;
        for (const RaycastProbe& probe : *probes) {
            outside += probe.kind == RaycastProbe::surface;
            inner += probe.kind == RaycastProbe::innerSide;
            if (probe.kind == RaycastProbe::surface)
                off = std::max(off, std::abs(glm::length(probe.rest) - 0.04));
        }
        EXPECT_GT(outside, 1000);
        EXPECT_EQ(inner, 0);
        EXPECT_LT(off, 0.25 * volume->grid().step);
    }
}

// A thin wall stands in what is cut away, far below the skin: how far that is says nothing of the wall.
TEST_F(GlRaycastSkipTight, AWallWithinACutIsNotOverrun) {
    const auto volume = ballVolume(64, 0.006);
    ASSERT_TRUE(volume.ok()) << volume.error().message;
    constexpr int kTexels = 64, kWall = 33;
    std::vector<glm::dvec4> texels;
    for (int i = 0; i < kTexels * kTexels * kTexels; ++i)
        texels.emplace_back(0, 0, 0, i % kTexels < 20 || i % kTexels == kWall ? 1 : 0);
    const auto texture =
        DeformationTexture::create(glm::ivec3(kTexels), glm::dvec3(0.05), TexelFormat::single, texels);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    const sim::Lattice space = objectSpace(0.004);
    auto caster = Raycaster::create(space, *volume);
    ASSERT_TRUE(caster.ok());
    caster->setWarp(Warp{&*texture, {}});
    const RaycastView view = RaycastView::of(space, glm::dvec3(-kRadius), glm::dvec3(kRadius),
                                             {-0.9, -0.2, -0.3}, sim::Projection::perspective, 96, 96);
    const double wall = (kWall + 0.5) * texture->texelSize().x - texture->half().x;
    for (const Search search : {Search::linear, Search::jacobian}) {
        RaycastLook look;
        look.search = search;
        const auto probes = caster->probe(view.frame, look, view.width, view.height);
        ASSERT_TRUE(probes.ok()) << probes.error().message;
        int crossing = 0, met = 0;
        for (std::size_t i = 0; i < probes->size(); ++i) {
            const RaycastView::Ray ray = view.ray(i);
            const glm::dvec3 at = ray.from + (wall - ray.from.x) / ray.along.x * ray.along;
            if (glm::length(at) > 0.037)
                continue;
            ++crossing;
            met += std::abs((*probes)[i].rest.x - wall) < 0.6 * texture->texelSize().x;
        }
        EXPECT_GT(crossing, 1000);
        EXPECT_EQ(met, crossing);
    }
}

class GlRaycastSkip : public test::GlTest, public ::testing::WithParamInterface<Case> {};

TEST_P(GlRaycastSkip, ShowsTheSame) {
    const Case& tested = GetParam();
    const auto volume = ballVolume(48, 0.012);
    ASSERT_TRUE(volume.ok()) << volume.error().message;
    const auto texture = DeformationTexture::bake(ballMap(tested.kind), glm::ivec3(40), TexelFormat::half);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    Warp warp{&*texture, {}};
    // Turned, and of other scales along its axes.
    warp.mapping.objectFromLocal = glm::dmat4(1);
    warp.mapping.objectFromLocal[0] = 1.1 * glm::dvec4(0.8, 0, 0.6, 0);
    warp.mapping.objectFromLocal[2] = 0.9 * glm::dvec4(-0.6, 0, 0.8, 0);
    warp.mapping.objectFromLocal[3] = glm::dvec4(0.002, 0.001, -0.003, 1);
    warp.mapping.cylinderRadius = tested.wound;
    const sim::Lattice space = objectSpace(0.004);
    auto caster = Raycaster::create(space, *volume);
    ASSERT_TRUE(caster.ok());
    caster->setWarp(warp);
    RaycastAgreement agreement;
    for (const auto& [direction, projection] :
         {std::pair{glm::dvec3(-0.3, -0.8, -0.6), sim::Projection::perspective},
          {glm::dvec3(0.6, 0.2, -0.8), sim::Projection::orthographic}}) {
        const RaycastView view = RaycastView::of(space, 1.3 * glm::dvec3(-kRadius), 1.3 * glm::dvec3(kRadius),
                                                 direction, projection, 128, 96);
        RaycastLook look;
        look.solid = tested.solid;
        look.search = tested.search;
        look.step = 0.25;
        look.skipField = look.skipCut = false;
        const auto reference = caster->probe(view.frame, look, view.width, view.height);
        ASSERT_TRUE(reference.ok()) << reference.error().message;
        look.skipField = look.skipCut = true;
        const auto probes = caster->probe(view.frame, look, view.width, view.height);
        ASSERT_TRUE(probes.ok()) << probes.error().message;
        addAgreement(agreement, *probes, *reference, 0.01 * volume->grid().step);
    }
    ASSERT_GT(agreement.object, 3000);
    EXPECT_LE(agreement.silhouettes, 4) << "of " << agreement.object;
    EXPECT_LE(agreement.deep, agreement.both / 1000) << "of " << agreement.both;
}

INSTANTIATE_TEST_SUITE_P(
    Maps, GlRaycastSkip,
    ::testing::Values(Case{"twistLinear", MapKind::twist, Solid::solid, Search::linear},
                      Case{"bendJacobian", MapKind::bend, Solid::hollow, Search::jacobian},
                      Case{"pullThreshold", MapKind::pull, Solid::shell, Search::threshold},
                      Case{"peelJacobian", MapKind::peel, Solid::solid, Search::jacobian},
                      Case{"knifeShell", MapKind::knife, Solid::shell, Search::jacobian},
                      Case{"seamHollow", MapKind::seam, Solid::hollow, Search::jacobian},
                      Case{"knifeWound", MapKind::knife, Solid::solid, Search::jacobian, 0.03}),
    [](const auto& tested) { return std::string(tested.param.name); });

} // namespace
} // namespace serosa::render
