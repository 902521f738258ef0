// Textures of tissue: they repeat, differ, stay the same, and refuse what does not fit.
#include "render/image.h"
#include "render/surface_seams.h"
#include "render/tissue_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

namespace serosa::render {
namespace {

constexpr sim::TissueTexture kAll[] = {sim::TissueTexture::heartMuscle, sim::TissueTexture::fat,
                                       sim::TissueTexture::liverCapsule, sim::TissueTexture::kidney};

TEST(TissueTexture, TilesRepeatWithoutASeam) {
    for (const sim::TissueTexture kind : kAll) {
        const TissueMaps maps = makeTissue(kind, 0.024, 0.0004);
        const auto height = [&](int x, int y) {
            return double(maps.relief[4 * std::size_t((y & 511) * 512 + (x & 511)) + 2]);
        };
        double inside = 0, across = 0, spread = 0, mean = 0;
        for (int i = 0; i < 512; ++i) {
            for (int j = 0; j < 511; ++j) {
                inside +=
                    (std::abs(height(j + 1, i) - height(j, i)) + std::abs(height(i, j + 1) - height(i, j))) /
                    511;
                mean += height(i, j) / (512 * 511);
            }
            across += std::abs(height(512, i) - height(511, i)) + std::abs(height(i, 512) - height(i, 511));
        }
        for (int i = 0; i < 512; ++i)
            spread += std::abs(height(i, 3 * i) - mean) / 512;
        EXPECT_LE(across, 1.5 * inside) << int(kind);
        EXPECT_GE(spread, 6) << "nothing is on it: " << int(kind);
    }
}

TEST(TissueTexture, IsTheSameEachTimeAndOfEachKindAnother) {
    std::set<std::vector<std::uint8_t>> known;
    glm::vec3 means[std::size(kAll)];
    for (std::size_t i = 0; i < std::size(kAll); ++i) {
        const TissueMaps maps = makeTissue(kAll[i], 0.02, 0.0003);
        known.insert(maps.albedo);
        means[i] = maps.mean;
        if (i > 0)
            continue;
        const TissueMaps deep = makeTissue(kAll[i], 0.02, 0.0006);
        EXPECT_EQ(maps.albedo, deep.albedo);
        EXPECT_NE(maps.relief, deep.relief);
    }
    EXPECT_EQ(known.size(), std::size(kAll));
    EXPECT_GT(means[1].y, 4 * means[2].y); // fat's yellow is brighter than a liver
}

// A ramp: its normals lean against the slope, by what relief and tile say.
TEST(TissueTexture, NormalsOfAHeightMap) {
    const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "ramp.png";
    Image ramp{64, 32, {}};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            ramp.rgb.insert(ramp.rgb.end(), 3, std::uint8_t(4 * y)); // rises towards the bottom: v falls
    ASSERT_TRUE(writePng(ramp, file).ok());
    sim::OrganLook look;
    look.height = file;
    look.tile = 0.064;
    look.relief = 0.064;
    const auto maps = tissueMaps(look, {});
    ASSERT_TRUE(maps.ok()) << maps.error().message;
    const double slope = -64 * 4 / 255.0; // relief over a texel of 1 mm, 4/255 a row
    for (const int y : {8, 20}) {
        const std::uint8_t* texel = &maps->relief[4 * std::size_t(y * 64 + 30)];
        EXPECT_NEAR(texel[0], 127.5, 1);
        EXPECT_NEAR((texel[1] - 127.5) / 127.5, -slope / std::sqrt(1 + slope * slope), 0.01);
    }
}

TEST(TissueTexture, RefusesOddSizesAndMissingFiles) {
    const std::filesystem::path folder = ::testing::TempDir();
    const auto written = [&](const char* name, int width, int height) {
        const Image image{width, height, std::vector<std::uint8_t>(std::size_t(width * height * 3), 100)};
        EXPECT_TRUE(writePng(image, folder / name).ok());
        return folder / name;
    };
    sim::OrganLook look;
    look.albedoLine = 7;
    look.normalLine = 8;
    const auto refused = [&](const std::string& what) {
        const auto maps = tissueMaps(look, "scene.toml");
        ASSERT_FALSE(maps.ok());
        EXPECT_NE(maps.error().message.find(what), std::string::npos) << maps.error().message;
    };
    look.albedo = written("odd.png", 48, 64);
    refused("scene.toml:7: " + look.albedo.string() + ": is 48 x 64 pixels");
    look.albedo = written("tiny.png", 2, 2);
    refused("powers of two from 4 to 4096");
    look.albedo = written("even.png", 64, 64);
    look.normal = written("other.png", 32, 32);
    refused("scene.toml:8: ");
    look.normal = folder / "none.png";
    refused("scene.toml:8: " + look.normal.string());
    look.normal = folder; // a folder is no picture
    refused("scene.toml:8: ");
}

// A square whose right triangle lies elsewhere in the texture, mirrored: the shared edge is drawn twice.
TEST(SurfaceSeams, VerticesAlongASeamAreDrawnForEachCoordinate) {
    sim::TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0.5, 0}, {0.25, 0.5}, {0.5, 0.5}};
    const std::vector<glm::dvec3> normals(4, {0, 0, 1});
    const DrawnVertices drawn = drawnVertices(mesh, normals);
    EXPECT_EQ(drawn.origin, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 2}));
    EXPECT_EQ(drawn.faces[0], glm::uvec3(0, 1, 2));
    EXPECT_EQ(drawn.faces[1], glm::uvec3(4, 5, 3));
    EXPECT_EQ(drawn.textures[4].uv, glm::vec2(0.5, 0));
    EXPECT_NEAR(glm::distance(drawn.textures[1].tangent, glm::vec4(1, 0, 0, 1)), 0, 1e-6);
    EXPECT_EQ(drawn.textures[5].tangent.w, -1); // u runs to the left
    EXPECT_LT(drawn.textures[5].tangent.x, -0.9F);
    mesh.uvs.clear();
    const DrawnVertices plain = drawnVertices(mesh, normals);
    EXPECT_EQ(plain.origin.size(), 4U);
    EXPECT_TRUE(plain.textures.empty());
}

} // namespace
} // namespace serosa::render
