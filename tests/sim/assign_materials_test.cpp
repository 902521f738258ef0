// Which cell a region gives its material to, against volumes of balls and shells, known in closed form.

#include "sim/assign_materials.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace serosa::sim {
namespace {

constexpr double kRadius = 0.03, kSpacing = 0.0013; // m
constexpr double kPi = std::numbers::pi;

double ballVolume(double radius) {
    return 4.0 / 3 * kPi * radius * radius * radius;
}

MaterialRegion layer(double from, double depth, std::size_t material = 1) {
    MaterialRegion region;
    region.kind = MaterialRegion::Kind::layer;
    region.material = material;
    region.from = from;
    region.depth = depth;
    return region;
}

MaterialRegion sphere(const glm::dvec3& centre, double radius, std::size_t material = 1) {
    MaterialRegion region;
    region.material = material;
    region.place.shape = Region::Shape::sphere;
    region.place.centre = centre;
    region.place.radius = radius;
    return region;
}

MaterialRegion painted(const glm::u8vec3& colour, std::size_t material = 1) {
    MaterialRegion region;
    region.kind = MaterialRegion::Kind::painted;
    region.material = material;
    region.colour = colour;
    return region;
}

std::string noPosition(int line) {
    return "scene:" + std::to_string(line) + ": ";
}

Tissue tissueOf(std::size_t materials) {
    Tissue tissue;
    for (std::size_t i = 1; i < materials; ++i) {
        tissue.others.push_back({});
        tissue.others.back().density = 1000 + 100 * double(i);
    }
    return tissue;
}

class AssignMaterials : public ::testing::Test {
protected:
    /// Red towards +x, blue elsewhere.
    static TriangleMesh ball() {
        TriangleMesh mesh = test::ballMesh(kRadius, 5);
        for (const glm::dvec3& position : mesh.positions)
            mesh.colours.push_back(position.x > 0 ? glm::u8vec3(200, 30, 30) : glm::u8vec3(30, 30, 200));
        return mesh;
    }
    std::vector<MaterialAmount> amounts(const std::vector<MaterialRegion>& regions,
                                        double spacing = kSpacing) {
        LatticeRequest request;
        request.spacing = spacing;
        lattice_ = buildLattice(mesh_, request).value();
        const Status assigned = assignMaterials(lattice_, mesh_, regions, noPosition);
        EXPECT_TRUE(assigned.ok()) << assigned.error().message;
        return materialAmounts(lattice_, tissueOf(4));
    }
    std::string problemOf(const MaterialRegion& region) {
        LatticeRequest request;
        request.spacing = kSpacing;
        lattice_ = buildLattice(mesh_, request).value();
        const Status assigned = assignMaterials(lattice_, mesh_, {region}, noPosition);
        return assigned.ok() ? "" : assigned.error().message;
    }
    TriangleMesh mesh_ = ball();
    Lattice lattice_;
};

TEST_F(AssignMaterials, LayersAreShellsOfTheirDepth) {
    for (const double depth : {0.003, 0.005, 0.010}) {
        const std::vector<MaterialAmount> found = amounts({layer(0, depth)});
        const double shell = ballVolume(kRadius) - ballVolume(kRadius - depth);
        EXPECT_NEAR(found[1].volume / shell, 1, 0.03) << depth;
        EXPECT_NEAR((found[0].volume + found[1].volume) / ballVolume(kRadius), 1, 0.005);
        EXPECT_DOUBLE_EQ(found[1].mass, found[1].volume * 1100);
        EXPECT_DOUBLE_EQ(found[0].mass, found[0].volume * 1000);
    }
    // Between two depths, and far below the surface.
    for (const auto& [from, depth] :
         {std::pair{0.004, 0.009}, std::pair{0.002, 0.004}, std::pair{0.015, 1.0}}) {
        const std::vector<MaterialAmount> found = amounts({layer(from, depth)});
        const double shell = ballVolume(kRadius - from) - ballVolume(std::max(0.0, kRadius - depth));
        EXPECT_NEAR(found[1].volume / shell, 1, 0.03) << from;
    }
}

// What lies outside of the surface is not below it, however far away.
TEST_F(AssignMaterials, NoLayerBelowTheSurfaceHoldsWhatLiesOutside) {
    amounts({layer(1e-5, 1)});
    std::size_t outside = 0;
    for (const LatticeCell& cell : lattice_.cells) {
        const double radius =
            glm::length(lattice_.toWorld(glm::dvec3(cell.grid - lattice_.centre) + glm::dvec3(0.5)));
        if (radius < kRadius - 5e-5) { // the ball's facets lie within that
            EXPECT_EQ(cell.material, 1) << radius;
        } else if (radius > kRadius) {
            EXPECT_EQ(cell.material, 0) << radius;
            ++outside;
        }
    }
    EXPECT_GT(outside, 100u);
}

// A layer thinner than a cell: all cells at the surface and no other, whether they are partly filled or the
// surface lies on their faces.
TEST_F(AssignMaterials, ThinLayersAreOneCellThick) {
    amounts({layer(0, 1e-5)});
    for (const LatticeCell& cell : lattice_.cells)
        if (cell.fill < 255) {
            EXPECT_EQ(cell.material, 1);
        }
    Lattice block = test::blockLattice(4, 5, 6, kSpacing);
    const TriangleMesh box = test::boxMesh(block.toWorld(-glm::dvec3(block.centre)),
                                           block.toWorld(glm::dvec3(4, 5, 6) - glm::dvec3(block.centre)));
    ASSERT_TRUE(assignMaterials(block, box, {layer(0, 1e-5)}, noPosition).ok());
    EXPECT_EQ(materialAmounts(block, tissueOf(2))[0].cells, 2u * 3u * 4u);
    EXPECT_EQ(materialAmounts(block, tissueOf(2))[1].cells, 4u * 5u * 6u - 2u * 3u * 4u);
}

TEST_F(AssignMaterials, SpheresHaveTheirVolume) {
    EXPECT_NEAR(amounts({sphere({0.004, -0.003, 0.001}, 0.012)})[1].volume / ballVolume(0.012), 1, 0.03);
    // Half of it outside: a cap of two balls of one radius, a radius apart: 5/12 pi r^3.
    EXPECT_NEAR(amounts({sphere({kRadius, 0, 0}, kRadius)})[1].volume /
                    (5.0 / 12 * kPi * std::pow(kRadius, 3)),
                1, 0.03);
}

TEST_F(AssignMaterials, PaintReachesAsDeepAsItSays) {
    // To the middle: the half with x > 0.
    EXPECT_NEAR(amounts({painted({200, 30, 30})})[1].volume / (ballVolume(kRadius) / 2), 1, 0.04);
    for (const LatticeCell& cell : lattice_.cells) {
        const double x = lattice_.toWorld(glm::dvec3(cell.grid - lattice_.centre) + glm::dvec3(0.5)).x;
        if (std::abs(x) > kSpacing) {
            EXPECT_EQ(cell.material, x > 0 ? 1 : 0) << x;
        }
    }
    MaterialRegion skin = painted({194, 36, 30}); // within the tolerance
    skin.depth = 0.005;
    EXPECT_NEAR(amounts({skin})[1].volume / ((ballVolume(kRadius) - ballVolume(kRadius - 0.005)) / 2), 1,
                0.05);
    skin.tolerance = 5; // no longer
    EXPECT_EQ(problemOf(skin),
              "scene:0: the model has no paint of colour [194, 36, 30]: the nearest colour is "
              "[200, 30, 30]");
}

TEST_F(AssignMaterials, LaterRegionsWin) {
    const std::vector<MaterialAmount> found =
        amounts({layer(0, 0.006, 1), sphere({0, 0, 0}, 0.02, 2), sphere({0, 0, 0}, 0.1, 3),
                 sphere({0, 0, 0}, 0.015, 0)});
    EXPECT_EQ(found[1].cells, 0u) << "overwritten as a whole, which is allowed";
    EXPECT_EQ(found[2].cells, 0u);
    EXPECT_NEAR(found[0].volume / ballVolume(0.015), 1, 0.03);
    EXPECT_NEAR((found[0].volume + found[3].volume) / ballVolume(kRadius), 1, 0.005);
}

TEST_F(AssignMaterials, RegionsThatHoldNothingAreRefused) {
    MaterialRegion far = sphere({1, 0, 0}, 0.1);
    far.place.line = 12;
    EXPECT_EQ(problemOf(far),
              "scene:12: this region holds no cell of the organ: look at its position and unit, or "
              "take a finer lattice");
    EXPECT_NE(problemOf(layer(0.05, 0.06)).find("this layer holds no cell"), std::string::npos);
    EXPECT_NE(problemOf(sphere(glm::dvec3(kSpacing * 0.3), 1e-6)).find("finer lattice"), std::string::npos);
    MaterialRegion inner = painted({200, 30, 30});
    inner.from = 0.04;
    EXPECT_NE(problemOf(inner).find("look at depth and from"), std::string::npos);
    mesh_.colours.clear();
    EXPECT_NE(problemOf(painted({200, 30, 30})).find("no vertex colours"), std::string::npos);
}

} // namespace
} // namespace serosa::sim
