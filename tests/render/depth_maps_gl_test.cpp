// Depth maps: against rays through the mesh in double, bodies that are known, what they cannot see, and the
// shader against its twin with dense samples.
#include "models/phantom.h"
#include "render/depth_maps.h"
#include "render/raycast_measures.h"
#include "tests/gl_fixture.h"
#include "tests/render/ball_maps.h"
#include "tests/render/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace serosa::render {
namespace {

constexpr double kRadius = 0.04; // m
constexpr int kWidth = 96, kHeight = 72, kSamples = 48;

class GlDepthMaps : public test::GlTest {
protected:
    static VolumeGrid gridOf(const sim::TriangleMesh& mesh, int samples = kSamples) {
        return VolumeGrid::around(mesh.lowest(), mesh.highest(), samples, 3);
    }
    static DepthMaps mapsOf(const sim::TriangleMesh& mesh, const DepthPlan& plan, int samples = kSamples) {
        auto made = DepthMaps::create(mesh, gridOf(mesh, samples), plan);
        EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
        return std::move(*made);
    }
    static sim::TriangleMesh ball() { return test::ballMesh(24, kRadius, glm::dvec3(0)); }
    static sim::TriangleMesh box(const glm::dvec3& half) {
        sim::TriangleMesh mesh = test::ballMesh(1, std::sqrt(3.0), glm::dvec3(0));
        for (glm::dvec3& p : mesh.positions)
            p = half * glm::sign(p);
        return mesh;
    }
    /// Two shells, the inner one wound the other way: what lies between them.
    static sim::TriangleMesh hollowBall(double inner) {
        sim::TriangleMesh mesh = ball(), within = test::ballMesh(16, inner, glm::dvec3(0));
        const auto first = std::uint32_t(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), within.positions.begin(), within.positions.end());
        for (const glm::uvec3& f : within.faces)
            mesh.faces.emplace_back(first + f.x, first + f.z, first + f.y);
        return mesh;
    }
    /// About the y axis.
    static sim::TriangleMesh torus(double radius, double tube) {
        constexpr std::uint32_t kAround = 64, kTube = 32;
        sim::TriangleMesh mesh;
        for (std::uint32_t i = 0; i < kAround; ++i)
            for (std::uint32_t j = 0; j < kTube; ++j) {
                const double a = 2 * std::numbers::pi * i / kAround, b = 2 * std::numbers::pi * j / kTube,
                             r = radius + tube * std::cos(b);
                mesh.positions.emplace_back(r * std::cos(a), tube * std::sin(b), r * std::sin(a));
                const auto at = [](std::uint32_t k, std::uint32_t l) {
                    return k % kAround * kTube + l % kTube;
                };
                mesh.faces.emplace_back(at(i, j), at(i, j + 1), at(i + 1, j + 1));
                mesh.faces.emplace_back(at(i, j), at(i + 1, j + 1), at(i + 1, j));
            }
        return mesh;
    }
    struct Shown {
        RaycastView view;
        std::vector<RaycastProbe> probes;
    };
    static Shown show(const sim::TriangleMesh& mesh, const RayField& field, const glm::dvec3& direction,
                      const RaycastLook& look = {}, const std::optional<Warp>& warp = std::nullopt) {
        const sim::Lattice space = objectSpace(glm::distance(mesh.lowest(), mesh.highest()) / 30);
        auto caster = Raycaster::create(space, field);
        EXPECT_TRUE(caster.ok());
        caster->setWarp(warp);
        Shown shown{RaycastView::of(space, 1.3 * mesh.lowest(), 1.3 * mesh.highest(), direction,
                                    sim::Projection::orthographic, kWidth, kHeight),
                    {}};
        auto probes = caster->probe(shown.view.frame, look, kWidth, kHeight);
        EXPECT_TRUE(probes.ok()) << (probes.ok() ? "" : probes.error().message);
        shown.probes = std::move(*probes);
        return shown;
    }
};

const DepthPlan kCube{FieldKind::depthCube, 0}, kAlongZ{FieldKind::depth, 2};

TEST_F(GlDepthMaps, TakeTheMemoryThatThePaperSays) {
    // 128 voxels along each side: 122 samples and a margin of three around.
    const sim::TriangleMesh mesh = box(glm::dvec3(0.03));
    const VolumeGrid grid = gridOf(mesh, 122);
    ASSERT_EQ(grid.size, glm::ivec3(128));
    EXPECT_EQ(mapsOf(mesh, kCube, 122).bytes(), 6 * 64 * 1024u);
    EXPECT_EQ(mapsOf(mesh, kAlongZ, 122).bytes(), 2 * 64 * 1024u);
    // The paper's volume has four bytes a voxel, 8 MB; ours has half floats.
    const auto volume = DistanceVolume::create(mesh, grid, 0);
    ASSERT_TRUE(volume.ok()) << volume.error().message;
    EXPECT_EQ(2 * volume->texture().bytes(), 8 * 1024 * 1024u);
}

TEST_F(GlDepthMaps, AreThoseOfRaysInDouble) {
    auto mesh = models::phantomInMetres("heart", 12000);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    for (const DepthPlan& plan : {kCube, kAlongZ, DepthPlan{FieldKind::depth, 0}}) {
        const DepthLayers made = mapsOf(*mesh, plan).read(), exact = depthsOnGrid(*mesh, gridOf(*mesh), plan);
        ASSERT_EQ(made.layers.size(), exact.layers.size());
        std::size_t off = 0, body = 0;
        for (std::size_t layer = 0; layer < made.layers.size(); ++layer)
            for (std::size_t i = 0; i < made.layers[layer].size(); ++i) {
                const glm::dvec2 &a = made.layers[layer][i], &b = exact.layers[layer][i];
                body += b.x <= b.y;
                off += glm::distance(a, b) > 1e-3;
            }
        EXPECT_GT(body, 500 * made.layers.size());
        EXPECT_LT(double(off), 0.002 * double(body)) << "of " << body; // an edge through a texel's middle
    }
}

TEST_F(GlDepthMaps, ABallIsABall) {
    const sim::TriangleMesh mesh = ball();
    const double voxel = gridOf(mesh).step;
    for (const DepthPlan& plan : {kCube, kAlongZ}) {
        const DepthMaps maps = mapsOf(mesh, plan);
        for (const glm::dvec3& direction : {glm::dvec3(0.3, -0.4, -1), glm::dvec3(1, 0.2, 0.1)}) {
            const Shown shown = show(mesh, maps.field(), direction);
            int hits = 0, wrong = 0;
            // Alone, the rim that the axis sees is right to half of a texel.
            const double doubt = plan.kind == FieldKind::depth ? 0.8 * voxel : 0.35 * voxel;
            std::vector<double> turned, off;
            for (std::size_t i = 0; i < shown.probes.size(); ++i) {
                const RaycastView::Ray ray = shown.view.ray(i);
                const double miss = glm::length(ray.from - glm::dot(ray.from, ray.along) * ray.along);
                if (std::abs(miss - kRadius) < doubt)
                    continue;
                const RaycastProbe& probe = shown.probes[i];
                wrong += (probe.kind == RaycastProbe::surface) != (miss < kRadius);
                if (probe.kind != RaycastProbe::surface)
                    continue;
                ++hits;
                off.push_back(std::abs(glm::length(probe.rest) - kRadius) / voxel);
                turned.push_back(
                    std::acos(std::min(glm::dot(probe.normal, glm::normalize(probe.rest)), 1.0)) * 180 /
                    std::numbers::pi);
            }
            std::sort(off.begin(), off.end());
            std::sort(turned.begin(), turned.end());
            EXPECT_EQ(wrong, 0) << int(plan.kind);
            ASSERT_GT(hits, 700);
            EXPECT_LT(off[off.size() * 95 / 100], plan.kind == FieldKind::depth ? 0.5 : 0.1);
            EXPECT_LT(turned[turned.size() / 2], 1.5);
            EXPECT_LT(turned[turned.size() * 9 / 10], plan.kind == FieldKind::depth ? 15 : 5);
        }
    }
}

TEST_F(GlDepthMaps, ACubeIsACube) {
    const glm::dvec3 half(0.04, 0.025, 0.03);
    const sim::TriangleMesh mesh = box(half);
    const DepthMaps maps = mapsOf(mesh, kCube);
    const double voxel = gridOf(mesh).step;
    const Shown shown = show(mesh, maps.field(), {-0.5, -0.6, -1});
    int hits = 0, wrong = 0;
    std::vector<double> off;
    for (std::size_t i = 0; i < shown.probes.size(); ++i) {
        const RaycastView::Ray ray = shown.view.ray(i);
        const glm::dvec2 small = slabOf(ray, glm::dvec3(0.3 * voxel) - half, half - 0.3 * voxel),
                         large = slabOf(ray, glm::dvec3(-0.3 * voxel) - half, half + 0.3 * voxel),
                         exact = slabOf(ray, -half, half);
        if ((small.x < small.y) != (large.x < large.y))
            continue;
        const RaycastProbe& probe = shown.probes[i];
        wrong += (probe.kind == RaycastProbe::surface) != (exact.x < exact.y);
        if (probe.kind != RaycastProbe::surface)
            continue;
        ++hits;
        off.push_back(glm::distance(probe.rest, ray.from + exact.x * ray.along) / voxel);
    }
    EXPECT_EQ(wrong, 0);
    ASSERT_GT(hits, 700);
    std::sort(off.begin(), off.end());
    EXPECT_LT(off[off.size() * 95 / 100], 0.1);
    EXPECT_LT(off.back(), 0.6);
}

// Both ways to a normal, of a field that is no distance.
TEST_F(GlDepthMaps, NormalsOfTheGradientAreThoseOfTheMap) {
    const sim::TriangleMesh mesh = ball();
    const auto texture = DeformationTexture::bake(ballMap(MapKind::twist), glm::ivec3(48), TexelFormat::half);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    const DepthMaps maps = mapsOf(mesh, kCube);
    RaycastLook gradient;
    gradient.normals = Normals::gradient;
    const glm::dvec3 direction(0.3, -0.4, -1);
    const Warp warp{&*texture, {}};
    const Shown one = show(mesh, maps.field(), direction, {}, warp),
                other = show(mesh, maps.field(), direction, gradient, warp);
    RaycastAgreement sum;
    addAgreement(sum, other.probes, one.probes, 1e-9);
    EXPECT_GT(sum.object, 700);
    EXPECT_EQ(sum.silhouettes + sum.deep, 0) << "only normals differ";
    EXPECT_LT(sum.medianTurn(), 3);
    EXPECT_GT(sum.medianTurn(), 0) << "they were found in two ways";
}

/// What is cut off above y = 0, seen from above: its face at rest.
double faceRadius(const std::vector<RaycastProbe>& probes, double& least) {
    double most = 0;
    least = 1;
    for (const RaycastProbe& probe : probes)
        if (probe.kind == RaycastProbe::cutFace) {
            most = std::max(most, std::hypot(probe.rest.x, probe.rest.z));
            least = std::min(least, std::hypot(probe.rest.x, probe.rest.z));
        }
    return most;
}

// A ball with a hollow inside, cut through its middle: a ring in truth, a disc to depth maps.
TEST_F(GlDepthMaps, WhatNoSideSeesIntoIsFilled) {
    const sim::TriangleMesh mesh = hollowBall(0.5 * kRadius);
    std::vector<glm::dvec4> texels;
    for (int i = 0; i < 64; ++i) // kept below y = 0
        texels.emplace_back(0, 0, 0, glm::clamp(0.5 + 0.5 * (31.5 - i), 0.0, 1.0));
    const auto texture =
        DeformationTexture::create({1, 64, 1}, glm::dvec3(0.06), TexelFormat::single, texels);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    const Warp warp{&*texture, {}};
    const auto volume = DistanceVolume::create(mesh, gridOf(mesh), 0);
    ASSERT_TRUE(volume.ok()) << volume.error().message;
    const double voxel = gridOf(mesh).step;
    double least = 0;
    const glm::dvec3 down(0, -1, 1e-7);
    EXPECT_NEAR(faceRadius(show(mesh, RayField::of(*volume), down, {}, warp).probes, least), kRadius, voxel);
    EXPECT_NEAR(least, 0.5 * kRadius, voxel);
    for (const DepthPlan& plan : {kCube, kAlongZ}) {
        const DepthMaps maps = mapsOf(mesh, plan);
        EXPECT_NEAR(faceRadius(show(mesh, maps.field(), down, {}, warp).probes, least), kRadius, 1.5 * voxel);
        EXPECT_LT(least, voxel) << "filled";
        // A shell's wall is measured along an axis: right where the surface lies across it.
        RaycastLook shell;
        shell.solid = Solid::shell;
        shell.thickness = 0.25 * kRadius;
        const Shown wall = show(mesh, maps.field(), down, shell, warp);
        double innermost = 1;
        for (const RaycastProbe& probe : wall.probes)
            if (probe.kind == RaycastProbe::cutFace && std::abs(probe.rest.x) < voxel)
                innermost = std::min(innermost, std::abs(probe.rest.z));
        EXPECT_NEAR(innermost, 0.75 * kRadius, 1.5 * voxel);
    }
}

// The hole of a ring: seen along its own axis, filled to those that lie across.
TEST_F(GlDepthMaps, ACubeSeesAHoleThatOneAxisFills) {
    const sim::TriangleMesh mesh = torus(0.03, 0.01);
    const glm::dvec3 down(0, -1, 1e-7);
    const auto middle = std::size_t(kHeight / 2 * kWidth + kWidth / 2);
    const DepthMaps cube = mapsOf(mesh, kCube), along = mapsOf(mesh, {FieldKind::depth, 1}),
                    across = mapsOf(mesh, {FieldKind::depth, 0});
    EXPECT_EQ(show(mesh, cube.field(), down).probes[middle].kind, RaycastProbe::nothing);
    EXPECT_EQ(show(mesh, along.field(), down).probes[middle].kind, RaycastProbe::nothing);
    EXPECT_EQ(show(mesh, across.field(), down).probes[middle].kind, RaycastProbe::surface);
}

TEST_F(GlDepthMaps, AMeshBeyondItsGridIsRefused) {
    const sim::TriangleMesh mesh = ball();
    VolumeGrid grid = gridOf(mesh);
    grid.lowest.x += 5 * grid.step;
    const auto made = DepthMaps::create(mesh, grid, kCube);
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message.find("beyond their grid"), std::string::npos);
    EXPECT_FALSE(DepthMaps::create({}, grid, kCube).ok());
}

struct Case {
    const char* name;
    FieldKind field;
    Solid solid;
    MapKind map;
    Search search;
};

class GlDepthMapsTwin : public GlDepthMaps, public ::testing::WithParamInterface<Case> {};

TEST_P(GlDepthMapsTwin, AgreesOnViews) {
    const Case& tested = GetParam();
    const sim::TriangleMesh mesh = ball();
    const DepthPlan plan{tested.field, 2};
    const DepthMaps maps = mapsOf(mesh, plan);
    const auto texture = DeformationTexture::bake(ballMap(tested.map), glm::ivec3(48), TexelFormat::half);
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    Warp warp{&*texture, {}};
    warp.mapping.objectFromLocal = glm::dmat4(1.02);
    warp.mapping.objectFromLocal[3] = glm::dvec4(0.002, 0.001, -0.003, 1);
    RaycastLook look;
    look.solid = tested.solid;
    look.search = tested.search;
    const VolumeGrid grid = maps.grid();
    const DepthLayers read = maps.read();
    const RaycastTwin twin([&](const glm::dvec3& rest) { return depthField(read, grid, plan, rest); },
                           grid.step, warp, look.solid, look.thickness, grid.step / 10);
    const sim::Lattice space = objectSpace(glm::distance(mesh.lowest(), mesh.highest()) / 30);
    auto caster = Raycaster::create(space, maps.field());
    ASSERT_TRUE(caster.ok());
    caster->setWarp(warp);
    RaycastAgreement sum;
    for (const glm::dvec3& direction : {glm::dvec3(0.3, -0.7, -0.8), glm::dvec3(-0.8, -0.5, 0.4)}) {
        const RaycastView view = RaycastView::of(
            space, 1.3 * mesh.lowest(), 1.3 * mesh.highest(), direction,
            sum.object ? sim::Projection::orthographic : sim::Projection::perspective, kWidth, kHeight);
        const auto probes = caster->probe(view.frame, look, kWidth, kHeight);
        ASSERT_TRUE(probes.ok()) << probes.error().message;
        addAgreement(sum, view, *caster, *probes, twin);
    }
    ASSERT_GT(sum.object, 1500);
    EXPECT_LT(sum.silhouetteShare(), 0.005) << sum.silhouettes << " of " << sum.object;
    EXPECT_LT(sum.deepShare(), 0.01) << sum.deep << " of " << sum.both;
    EXPECT_LT(sum.medianTurn(), 2.0);
}

INSTANTIATE_TEST_SUITE_P(
    Modes, GlDepthMapsTwin,
    ::testing::Values(
        Case{"cubeTwist", FieldKind::depthCube, Solid::solid, MapKind::twist, Search::jacobian},
        Case{"cubePull", FieldKind::depthCube, Solid::solid, MapKind::pull, Search::jacobian},
        Case{"cubeKnife", FieldKind::depthCube, Solid::solid, MapKind::knife, Search::linear},
        Case{"cubeSeamHollow", FieldKind::depthCube, Solid::hollow, MapKind::seam, Search::jacobian},
        Case{"cubePeelShell", FieldKind::depthCube, Solid::shell, MapKind::peel, Search::jacobian},
        Case{"depthBendHollow", FieldKind::depth, Solid::hollow, MapKind::bend, Search::jacobian},
        Case{"depthKnifeShell", FieldKind::depth, Solid::shell, MapKind::knife, Search::jacobian}),
    [](const auto& tested) { return std::string(tested.param.name); });

} // namespace
} // namespace serosa::render
