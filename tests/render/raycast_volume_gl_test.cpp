// A volume on the faces of cuts: its value at a place is known, and so is the colour that is drawn there.
// The light that falls on a place is not asked for: a face drawn with the volume must look as it does with a
// volume of one value, where that value is the one of the place.
#include "models/phantom.h"
#include "render/depth_maps.h"
#include "render/raycast_measures.h"
#include "tests/gl_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace serosa::render {
namespace {

constexpr int kSize = 80;
constexpr double kStep = 0.006; // m: of a voxel

class GlRaycastVolume : public test::GlTest {
protected:
    /// A ball of 40 mm whose upper half is cut away.
    void SetUp() override {
        GlTest::SetUp();
        auto mesh = models::makePhantom("ball", 2000);
        ASSERT_TRUE(mesh);
        for (glm::dvec3& p : mesh->positions)
            p = 0.04 * glm::normalize(p);
        auto field =
            DistanceVolume::create(*mesh, VolumeGrid::around(mesh->lowest(), mesh->highest(), 40, 3), 0.01);
        ASSERT_TRUE(field.ok());
        field_.emplace(std::move(*field));
        DeformationMap map;
        map.kind = MapKind::box;
        map.half = glm::dvec3(0.06);
        map.extent = map.width = 0.1;
        map.depth = 0.06;
        auto texture = DeformationTexture::bake(map, glm::ivec3(48), TexelFormat::half);
        ASSERT_TRUE(texture.ok());
        texture_.emplace(std::move(*texture));
        auto maps = DepthMaps::create(*mesh, field_->grid(), {FieldKind::depthCube, 0});
        ASSERT_TRUE(maps.ok());
        depths_.emplace(std::move(*maps));
        view_ = RaycastView::of(space_, glm::dvec3(-0.045), glm::dvec3(0.045), {0.2, -1, -0.4},
                                sim::Projection::perspective, kSize, kSize);
        take(RayField::of(*field_));
    }
    /// From now on this is the ball.
    void take(const RayField& field) {
        Warp warp{&*texture_, {}};
        warp.mapping.objectFromLocal[3] = glm::dvec4(0, 0.03, 0, 1);
        auto caster = Raycaster::create(space_, field);
        ASSERT_TRUE(caster.ok());
        caster->setWarp(warp);
        caster_.emplace(std::move(*caster));
        auto probes = caster_->probe(view_.frame, {}, kSize, kSize);
        ASSERT_TRUE(probes.ok()) << probes.error().message;
        probes_ = std::move(*probes);
    }
    void TearDown() override {
        caster_.reset();
        texture_.reset();
        depths_.reset();
        field_.reset();
        GlTest::TearDown();
    }

    /// Turned axes, so that each of spacing, direction and origin counts.
    static VoxelValues voxels(const std::function<double(const glm::dvec3&)>& value) {
        VoxelValues made;
        made.size = {11, 13, 12};
        const double c = std::cos(0.5), s = std::sin(0.5);
        made.worldFromVoxel = {glm::dvec4(kStep * c, 0, kStep * s, 0), glm::dvec4(0, kStep, 0, 0),
                               glm::dvec4(-kStep * s, 0, kStep * c, 0), glm::dvec4(0, -0.036, -0.05, 1)};
        for (int z = 0; z < made.size.z; ++z)
            for (int y = 0; y < made.size.y; ++y)
                for (int x = 0; x < made.size.x; ++x)
                    made.values.push_back(
                        float(value(glm::dvec3(made.worldFromVoxel * glm::dvec4(x, y, z, 1)))));
        return made;
    }
    std::vector<glm::vec4> drawn(const CutVolume* volume) {
        caster_->setCutVolume(volume);
        gpu::Texture2D colour("colour", GL_RGBA32F, kSize, kSize),
            depth("depth", GL_DEPTH_COMPONENT32F, kSize, kSize);
        gpu::Framebuffer target("target");
        target.attach(GL_COLOR_ATTACHMENT0, colour);
        target.attach(GL_DEPTH_ATTACHMENT, depth);
        target.setDrawBuffers(1);
        colour.clear(glm::vec4(0));
        target.bind(kSize, kSize);
        glClear(GL_DEPTH_BUFFER_BIT);
        glEnable(GL_DEPTH_TEST);
        const Status status = caster_->draw(view_.frame, {});
        EXPECT_TRUE(status.ok()) << status.error().message;
        glDisable(GL_DEPTH_TEST);
        std::vector<glm::vec4> rows(std::size_t(kSize) * kSize), flipped;
        colour.download(rows.data(), rows.size() * sizeof(glm::vec4));
        for (std::size_t i = 0; i < rows.size(); ++i)
            flipped.push_back(rows[(kSize - 1 - i / kSize) * kSize + i % kSize]);
        return flipped;
    }
    /// Voxel coordinates of a pixel's rest position, if it is a cut face.
    std::optional<glm::dvec3> faceAt(std::size_t i, const VoxelValues& in) const {
        if (probes_[i].kind != RaycastProbe::cutFace)
            return std::nullopt;
        return glm::dvec3(glm::inverse(in.worldFromVoxel) * glm::dvec4(probes_[i].rest, 1));
    }
    static double outside(const glm::dvec3& at, const glm::ivec3& size) { // voxels
        const glm::dvec3 most = glm::max(-0.5 - at, at - (glm::dvec3(size) - 0.5));
        return std::max({most.x, most.y, most.z});
    }

    sim::Lattice space_ = objectSpace(0.003);
    void labelsHaveTheirColours();

    std::optional<DistanceVolume> field_;
    std::optional<DepthMaps> depths_;
    std::optional<DeformationTexture> texture_;
    std::optional<Raycaster> caster_;
    RaycastView view_;
    std::vector<RaycastProbe> probes_;
};

TEST_F(GlRaycastVolume, GreyValuesAreThoseOfTheirPlacesUnderTheWindow) {
    constexpr double kLevel = 50, kWidth = 200;
    const auto value = [](const glm::dvec3& p) { return 60 + 4000 * p.x - 2500 * p.z + 1000 * p.y; };
    const VoxelValues in = voxels(value);
    const auto made = CutVolume::grey(in, kLevel, kWidth);
    ASSERT_TRUE(made.ok()) << made.error().message;
    const auto picture = drawn(&*made), flesh = drawn(nullptr);
    constexpr int kLevels = 16;
    std::vector<std::vector<glm::vec4>> of; // one value everywhere
    for (int k = 0; k <= kLevels; ++k) {
        const double v = kLevel + kWidth * (double(k) / kLevels - 0.5);
        const auto one = CutVolume::grey(voxels([v](const glm::dvec3&) { return v; }), kLevel, kWidth);
        ASSERT_TRUE(one.ok());
        of.push_back(drawn(&*one));
    }
    int faces = 0, wrong = 0, beyond = 0, clamped = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const auto at = faceAt(i, in);
        const double out = at ? outside(*at, in.size) : 1;
        if (std::abs(out) < 0.6) // of the volume's edge: outermost half voxels hold their value
            continue;
        if (out > 0) {
            beyond += at.has_value();
            EXPECT_EQ(picture[i], flesh[i]) << "the volume says nothing here";
            continue;
        }
        ++faces;
        const double share = (value(probes_[i].rest) - kLevel) / kWidth + 0.5,
                     within = std::clamp(share, 0.0, 1.0), level = std::min(kLevels * within, kLevels - 1e-6);
        clamped += share != within;
        const float low = of[std::size_t(level)][i].g, high = of[std::size_t(level) + 1][i].g;
        wrong += picture[i].g < low - 2e-3F || picture[i].g > high + 2e-3F;
        EXPECT_NEAR(picture[i].r / picture[i].g, of[std::size_t(level)][i].r / low, 0.25 * picture[i].r / low)
            << "grey as grey is under this light";
    }
    EXPECT_GT(faces, 500);
    EXPECT_GT(beyond, 50);
    EXPECT_GT(clamped, 50);
    EXPECT_EQ(wrong, 0) << "of " << faces;
}

void GlRaycastVolume::labelsHaveTheirColours() {
    VoxelValues in = voxels([](const glm::dvec3&) { return 0; });
    for (std::size_t i = 0; i < in.values.size(); ++i)
        in.values[i] = i % 11 < 5 ? 1 : i % 11 < 8 ? 7 : 2; // by x
    const glm::ivec3 red(200, 30, 20), blue(20, 40, 220);
    const auto made = CutVolume::labels(in, {{1, red}, {2, blue}});
    const auto picture = drawn(&*made), flesh = drawn(nullptr);
    VoxelValues ones = in;
    std::fill(ones.values.begin(), ones.values.end(), 1.0F);
    const auto allRed = CutVolume::labels(ones, {{1, red}}), allBlue = CutVolume::labels(ones, {{1, blue}});
    const auto reds = drawn(&*allRed), blues = drawn(&*allBlue);
    int counts[3] = {0, 0, 0};
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const auto at = faceAt(i, in);
        const double share = at ? at->x + 0.5 - std::floor(at->x + 0.5) : 0.5;
        if (!at || outside(*at, in.size) > -0.1 || share < 0.03 || share > 0.97)
            continue;
        const int x = int(std::floor(at->x + 0.5)), label = x < 5 ? 0 : x < 8 ? 1 : 2;
        ++counts[label];
        EXPECT_EQ(picture[i], label == 0 ? reds[i] : label == 1 ? flesh[i] : blues[i]) << at->x;
    }
    for (const int count : counts)
        EXPECT_GT(count, 50);
}

TEST_F(GlRaycastVolume, ColoursAreThoseOfTheirPlaces) {
    constexpr double kFrom = 20, kSlope = 4000; // of red, which grows along x
    const auto red = [](const glm::dvec3& p) { return std::clamp(kFrom + 80 + kSlope * p.x, 0.0, 255.0); };
    const auto coloured = [](const std::function<glm::vec3(const glm::dvec3&)>& colour) {
        VoxelValues made = voxels([](const glm::dvec3&) { return 0; });
        made.values.clear();
        for (int z = 0; z < made.size.z; ++z)
            for (int y = 0; y < made.size.y; ++y)
                for (int x = 0; x < made.size.x; ++x) {
                    const glm::vec3 at = colour(glm::dvec3(made.worldFromVoxel * glm::dvec4(x, y, z, 1)));
                    made.values.insert(made.values.end(), {at.r, at.g, at.b});
                }
        return made;
    };
    const VoxelValues in = coloured([&](const glm::dvec3& p) { return glm::vec3(red(p), 90, 30); });
    const auto made = CutVolume::colours(in);
    ASSERT_TRUE(made.ok()) << made.error().message;
    const auto picture = drawn(&*made);
    std::vector<std::vector<glm::vec4>> of; // one colour everywhere
    constexpr int kLevels = 17;
    for (int k = 0; k <= kLevels; ++k) {
        const auto one =
            CutVolume::colours(coloured([&](const glm::dvec3&) { return glm::vec3(15 * k, 90, 30); }));
        ASSERT_TRUE(one.ok());
        of.push_back(drawn(&*one));
    }
    int faces = 0, wrong = 0, levels = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const auto at = faceAt(i, in);
        if (!at || outside(*at, in.size) > -0.6 || red(probes_[i].rest) > 240 || red(probes_[i].rest) < 15)
            continue; // where red is clamped it is not linear between voxels
        ++faces;
        const double level = std::min(red(probes_[i].rest) / 15, kLevels - 1e-6);
        levels |= 1 << int(level);
        const float low = of[std::size_t(level)][i].r, high = of[std::size_t(level) + 1][i].r,
                    bytes = 0.1F * (high - low); // one and a half: texels and filters round
        wrong += picture[i].r < low - bytes || picture[i].r > high + bytes;
        EXPECT_NEAR(picture[i].b, of[std::size_t(level)][i].b, 6e-3)
            << "tone mapping mixes channels a little";
    }
    EXPECT_GT(faces, 500);
    EXPECT_GT(std::popcount(unsigned(levels)), 5) << "red changes over the face";
    EXPECT_EQ(wrong, 0) << "of " << faces;

    VoxelValues bad = in;
    bad.values[3 * 12 + 1] = 256;
    const auto loud = CutVolume::colours(bad);
    ASSERT_FALSE(loud.ok());
    EXPECT_NE(loud.error().message.find("(1, 1, 0)"), std::string::npos) << loud.error().message;
}

TEST_F(GlRaycastVolume, LabelsHaveTheirColoursAndOthersTheFlesh) {
    labelsHaveTheirColours();
}

TEST_F(GlRaycastVolume, LabelsHaveThemOnFacesOfDepthMapsToo) {
    take(depths_->field());
    labelsHaveTheirColours();
}

TEST_F(GlRaycastVolume, SaysWhetherItMeetsAndRefusesWhatIsNoVolume) {
    const VoxelValues in = voxels([](const glm::dvec3&) { return 1; });
    const auto made = CutVolume::grey(in, 0, 1);
    ASSERT_TRUE(made.ok());
    EXPECT_TRUE(made->meets(glm::dvec3(-0.04), glm::dvec3(0.04)));
    EXPECT_FALSE(made->meets(glm::dvec3(0.2, -0.04, -0.04), glm::dvec3(0.3, 0.04, 0.04)));
    // Beside the turned volume, but within the box around it.
    const glm::dvec3 corner(in.worldFromVoxel * glm::dvec4(10.5, 0, -0.5, 1));
    EXPECT_FALSE(made->meets(glm::dvec3(corner.x, -0.01, -0.06), glm::dvec3(corner.x + 0.01, 0.01, -0.045)));

    VoxelValues bad = in;
    bad.values[11 * 13 + 1] = std::numeric_limits<float>::quiet_NaN();
    const auto nan = CutVolume::grey(bad, 0, 1);
    ASSERT_FALSE(nan.ok());
    EXPECT_NE(nan.error().message.find("(1, 0, 1)"), std::string::npos) << nan.error().message;
    bad = in;
    bad.worldFromVoxel[1] = bad.worldFromVoxel[0];
    EXPECT_FALSE(CutVolume::grey(bad, 0, 1).ok());
    bad = in;
    bad.size.x = 1 << 24;
    EXPECT_FALSE(CutVolume::labels(bad, {{1, {1, 2, 3}}}).ok());
}

} // namespace
} // namespace serosa::render
