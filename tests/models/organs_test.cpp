// Liver, kidney and skin against what anatomy says of them.
#include "mesh_measures.h"
#include "models/kidney.h"
#include "models/liver.h"
#include "models/phantom.h"
#include "models/skin.h"

#include <gtest/gtest.h>

namespace serosa::models {
namespace {

constexpr double kMillilitre = 1000; // mm^3

/// Volume where `distance` is negative, by counting points `step` apart, mm^3.
template <typename Distance>
double countedVolume(const Distance& distance, const Point& lowest, const Point& highest, double step) {
    std::size_t inside = 0;
    for (double z = lowest.z; z < highest.z; z += step)
        for (double y = lowest.y; y < highest.y; y += step)
            for (double x = lowest.x; x < highest.x; x += step)
                inside += distance(Point(x, y, z)) < 0;
    return static_cast<double>(inside) * step * step * step;
}

/// Greenish, reddish and so on: differences of a vertex' channels.
std::size_t countColour(const sim::TriangleMesh& mesh, bool (*matches)(const glm::ivec3&)) {
    std::size_t count = 0;
    for (const auto& c : mesh.colours)
        count += matches(glm::ivec3(c));
    return count;
}

TEST(Liver, HasAnAdultsSize) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("liver");
    const glm::dvec3 size = test::extentsOf(mesh).size();
    EXPECT_NEAR(size.x, 200, 15);
    EXPECT_NEAR(size.y, 150, 15);
    EXPECT_GT(size.z, 110);
    EXPECT_LT(size.z, 170);
    const double volume = test::volumeOf(mesh);
    EXPECT_GT(volume, 1200 * kMillilitre);
    EXPECT_LT(volume, 1600 * kMillilitre);
    const Solid& solid = liverSolid();
    EXPECT_NEAR(countedVolume(solid.source.distance, solid.source.lowest, solid.source.highest, 3.0), volume,
                0.01 * volume)
        << "mesh and function disagree";
}

TEST(Liver, GallbladderHangsUnderTheRightLobe) {
    const Solid& solid = liverSolid();
    const double volume = countedVolume(gallbladderDistance, {-60, -90, -40}, {20, 0, 60}, 1.0);
    EXPECT_GT(volume, 15 * kMillilitre); // 30 to 50 ml, in part sunk in the fossa
    EXPECT_LT(volume, 60 * kMillilitre);
    double lowest = 1e9, highest = -1e9, rightmost = -1e9;
    for (double z = -40; z < 60; z += 2)
        for (double y = -90; y < 0; y += 2)
            for (double x = -60; x < 20; x += 2)
                if (gallbladderDistance({x, y, z}) < 0) {
                    EXPECT_LT(solid.source.distance({x, y, z}), 0) << "the gallbladder is part of the solid";
                    lowest = std::min(lowest, y);
                    highest = std::max(highest, y);
                    rightmost = std::max(rightmost, x);
                }
    EXPECT_LT(rightmost, 20);
    EXPECT_GT(highest - lowest, 40); // 70 to 100 mm long, aslant
    const auto green = [](const glm::ivec3& c) { return c.g > c.r + 8 && c.g > c.b + 8; };
    const auto brown = [](const glm::ivec3& c) { return c.r > 2 * c.g && c.r > 2 * c.b && c.r < 130; };
    const sim::TriangleMesh& mesh = test::defaultPhantom("liver");
    EXPECT_GT(countColour(mesh, green), mesh.colours.size() / 100);
    EXPECT_GT(countColour(mesh, brown), mesh.colours.size() / 2);
}

TEST(Liver, RightLobeIsTheLarger) {
    const auto side = [](double from, double to) {
        return countedVolume(liverTissueDistance, {from, -90, -85}, {to, 90, 75}, 4.0);
    };
    const double right = side(-106, 14), left = side(14, 108);
    EXPECT_GT(right, 2 * left);
    EXPECT_LT(right, 7 * left);
}

TEST(Kidney, AVolumeShowsCortexAroundPyramidsAndColumns) {
    const auto made = makePhantomVolume("kidney", 2);
    ASSERT_TRUE(made.ok()) << made.error().message;
    glm::dvec3 cortex(0);
    double outer = 0, deep = 0, pyramids = 0, columns = 0, outside = 0;
    for (std::size_t i = 0; i < made->voxels.size(); ++i) {
        const int x = made->size.x, y = made->size.y, at = int(i);
        const Point p = made->lowest + 2.0 * Point(at % x, at / x % y, at / (x * y));
        const glm::ivec3 colour(made->voxels[i]);
        const double depth = -kidneyBodyDistance(p);
        if (p.x > 5) // vessels, pelvis and fat
            continue;
        if (depth > 3 && depth < 5) {
            cortex += colour;
            ++outer;
        }
        if (depth > 10 && depth < 14) {
            ++deep;
            pyramids += colour.r < 141; // between the two
            columns += colour.r >= 141;
        }
        if (depth < -5) {
            EXPECT_EQ(colour, glm::ivec3(0));
            ++outside;
        }
    }
    ASSERT_GT(outer, 500);
    EXPECT_LT(glm::distance(cortex / outer, glm::dvec3(158, 84, 64)), 15);
    EXPECT_GT(pyramids / deep, 0.2);
    EXPECT_GT(columns / deep, 0.2);
    EXPECT_GT(outside, 500);
}

TEST(Kidney, HasAnAdultsSizeAndABeansShape) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("kidney");
    const glm::dvec3 size = test::extentsOf(mesh).size();
    EXPECT_NEAR(size.y, 110, 6);
    EXPECT_NEAR(size.z, 45, 4);
    const double volume = test::volumeOf(mesh);
    EXPECT_GT(volume, 120 * kMillilitre);
    EXPECT_LT(volume, 180 * kMillilitre);
    // The body alone is about 60 mm wide, and the hilum lies deeper than the poles' line.
    const auto edge = [](double y) {
        double x = 60;
        while (kidneyBodyDistance({x, y, -0.5}) > 0)
            x -= 0.1;
        return x;
    };
    double widest = -1e9, leftmost = 0;
    for (double y = -50; y <= 50; y += 1)
        widest = std::max(widest, edge(y));
    for (const auto& p : mesh.positions)
        leftmost = std::min(leftmost, p.x);
    EXPECT_NEAR(widest - leftmost, 60, 6);
    EXPECT_GT(std::min(edge(28), edge(-28)) - edge(0), 8);
}

TEST(Kidney, StumpsAreOpen) {
    const auto& distance = kidneySolid().source.distance;
    int inLumen = 0;
    const sim::TriangleMesh& mesh = test::defaultPhantom("kidney");
    const double medial = test::extentsOf(mesh).highest.x;
    for (double y = -10; y < 30; y += 0.5)
        for (double z = -15; z < 20; z += 0.5) {
            // In a lumen: nothing here, but a wall on all four sides.
            const Point p(medial - 4, y, z);
            const auto walled = [&](const Point& way) {
                for (double t = 0; t < 7; t += 0.2)
                    if (distance(p + t * way) < 0)
                        return true;
                return false;
            };
            inLumen += distance(p) > 0 && walled({0, 1, 0}) && walled({0, -1, 0}) && walled({0, 0, 1}) &&
                       walled({0, 0, -1});
        }
    EXPECT_GT(inLumen, 10);
}

TEST(Skin, LayersAreAsThickAsStatedAndInOrder) {
    const SkinLayer order[] = {SkinLayer::epidermis, SkinLayer::dermis, SkinLayer::fat, SkinLayer::muscle};
    const double expected[] = {1.2, 3.3, 8.0};
    double sum[3] = {};
    int count = 0;
    for (double x = -38; x <= 38; x += 1.7)
        for (double z = -38; z <= 38; z += 1.3, ++count) {
            double above = 0;
            for (int i = 0; i < 4; ++i) {
                const double end = skinInterface(order[i], x, z);
                ASSERT_GT(end, above + 0.4) << skinLayerName(order[i]) << " at " << x << ", " << z;
                const double middle = skinTop(x, z) - 0.5 * (above + end);
                EXPECT_EQ(skinLayerAt({x, middle, z}), order[i]);
                if (i < 3)
                    sum[i] += end - above;
                above = end;
            }
            EXPECT_NEAR(skinTop(x, z) - above, kSkinBottom, 1e-9) << "muscle ends at the bottom";
        }
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(sum[i] / count, expected[i], 0.1 * expected[i]) << skinLayerName(order[i]);
}

TEST(Skin, BottomIsFlatAndTheTopIsTheHeightFunction) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("skin");
    const auto box = test::extentsOf(mesh);
    EXPECT_NEAR(box.size().x, kSkinSide, 1);
    EXPECT_NEAR(box.size().y, kSkinThickness, 0.5);
    EXPECT_NEAR(box.size().z, kSkinSide, 1);
    EXPECT_NEAR(box.lowest.y, kSkinBottom, 1e-5);
    std::size_t bottom = 0, top = 0;
    double rough = 0;
    for (const auto& p : mesh.positions) {
        if (std::max(std::abs(p.x), std::abs(p.z)) > 37)
            continue;
        if (p.y < 0) {
            ++bottom;
            EXPECT_NEAR(p.y, kSkinBottom, 1e-5);
        } else {
            ++top;
            EXPECT_NEAR(p.y, skinTop(p.x, p.z), 1e-4);
            rough = std::max(rough, std::abs(skinTop(p.x + 1, p.z) - p.y));
        }
    }
    EXPECT_GT(bottom, 100u);
    EXPECT_GT(top, 5000u);
    EXPECT_GT(rough, 0.15) << "furrows";
    // 80 x 80 mm, the height's mean, without the edges' rounding.
    double mean = 0;
    for (int i = 0; i < 100; ++i)
        for (int k = 0; k < 100; ++k)
            mean += (skinTop(-39.6 + 0.8 * i, -39.6 + 0.8 * k) - kSkinBottom) / 10000;
    EXPECT_NEAR(test::volumeOf(mesh), kSkinSide * kSkinSide * mean, 0.015 * kSkinSide * kSkinSide * mean);
}

} // namespace
} // namespace serosa::models
