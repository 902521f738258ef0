// Golf ball and apple against what is known of them without their code, and all solids' slopes.
#include "mesh_measures.h"
#include "models/apple.h"
#include "models/golf_ball.h"
#include "models/kidney.h"
#include "models/liver.h"
#include "models/phantom.h"
#include "models/skin.h"

#include <gtest/gtest.h>

namespace serosa::models {
namespace {

const double kPi = glm::radians(180.0);

TEST(Solid, DistancesAreNoSteeperThanTheMesherAssumes) {
    for (const Solid* solid : {&liverSolid(), &kidneySolid(), &skinSolid(), &golfBallSolid(), &appleSolid(),
                               &appleSolid(AppleKind::thick)}) {
        const auto& distance = solid->source.distance;
        const Point lowest = solid->source.lowest, extent = solid->source.highest - lowest;
        double steepest = 0;
        for (int i = 0; i < 20000; ++i) { // an even sequence in the box
            const Point share =
                glm::fract(static_cast<double>(i) * Point(0.8191725134, 0.6710436067, 0.5497004779));
            const Point p = lowest + share * extent;
            const double d = distance(p);
            if (std::abs(d) > 6)
                continue;
            constexpr double e = 1e-4;
            const Point slope(distance(p + Point(e, 0, 0)) - d, distance(p + Point(0, e, 0)) - d,
                              distance(p + Point(0, 0, e)) - d);
            steepest = std::max(steepest, glm::length(slope) / e);
        }
        EXPECT_GT(steepest, 0.8) << solid->name;
        EXPECT_LT(steepest, 1.15) << solid->name;
    }
}

TEST(GolfBall, HasTheRadiusAndVolumeOfABallLessItsDimples) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("golfball");
    double least = 1e9, most = 0, mean = 0, area = 0;
    for (const auto& p : mesh.positions) {
        least = std::min(least, glm::length(p));
        most = std::max(most, glm::length(p));
    }
    for (const auto& f : mesh.faces) {
        const auto &a = mesh.positions[f.x], &b = mesh.positions[f.y], &c = mesh.positions[f.z];
        const double one = 0.5 * glm::length(glm::cross(b - a, c - a));
        mean += one * glm::length(a + b + c) / 3;
        area += one;
    }
    EXPECT_NEAR(most, 21.35, 0.01);
    EXPECT_NEAR(least, 21.35 - kDimpleDepth, 0.01);
    EXPECT_GT(mean / area, 21.35 - kDimpleDepth / 2);
    EXPECT_LT(mean / area, 21.35 - kDimpleDepth / 6);
    // A dimple is the lens between two spherical caps that meet in its rim: one of the ball, one hollow.
    const auto cap = [](double a, double h) { return kPi * h / 6 * (3 * a * a + h * h); };
    const double rim = kDimpleRadius, bulge = 21.35 - std::sqrt(21.35 * 21.35 - rim * rim);
    const double lens = cap(rim, bulge) + cap(rim, kDimpleDepth - bulge);
    const double ball = 4.0 / 3 * kPi * std::pow(21.35, 3);
    const double lost = ball - test::volumeOf(mesh);
    EXPECT_NEAR(lost, 336 * lens, 0.1 * 336 * lens); // rounded edges lose more
}

TEST(GolfBall, Has336DimplesEvenlySpread) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("golfball");
    // Vertices lower than all their neighbours; equal ones in one dimple count once.
    std::vector<bool> lowest(mesh.positions.size(), true);
    for (const auto& f : mesh.faces)
        for (int k = 0; k < 3; ++k) {
            const auto a = f[k], b = f[(k + 1) % 3];
            const double ra = glm::length(mesh.positions[a]), rb = glm::length(mesh.positions[b]);
            lowest[ra < rb ? b : a] = false;
        }
    std::vector<glm::dvec3> dimples;
    for (std::size_t i = 0; i < lowest.size(); ++i) {
        if (!lowest[i] || glm::length(mesh.positions[i]) > 21.35 - 0.5 * kDimpleDepth)
            continue;
        bool isNew = true;
        for (const auto& known : dimples)
            isNew = isNew && glm::length(known - mesh.positions[i]) > 1.0;
        if (isNew)
            dimples.push_back(mesh.positions[i]);
    }
    ASSERT_EQ(dimples.size(), 336u);
    // Points on a sphere cannot all be farther apart than in a honeycomb of their number.
    const double honeycomb = std::sqrt(4 * kPi * 21.35 * 21.35 / 336 * 2 / std::sqrt(3.0));
    for (const auto& a : dimples) {
        double nearest = 1e9;
        for (const auto& b : dimples)
            if (a != b)
                nearest = std::min(nearest, glm::length(a - b));
        EXPECT_GT(nearest, 0.85 * honeycomb);
        EXPECT_LT(nearest, 1.05 * honeycomb);
        EXPECT_GT(nearest, 2 * kDimpleRadius) << "dimples overlap";
    }
}

TEST(Apple, IsFivefoldAboutItsAxis) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("apple");
    const glm::dvec3 size = test::extentsOf(mesh).size();
    EXPECT_NEAR(size.x, 76, 2);
    EXPECT_NEAR(size.z, 76, 2);
    EXPECT_NEAR(size.y, 75, 3);
    // The body's vertices, turned by a fifth of a turn, lie on the surface again.
    const double c = std::cos(2 * kPi / 5), s = std::sin(2 * kPi / 5);
    std::size_t compared = 0;
    for (const auto& p : mesh.positions) {
        if (std::hypot(p.x, p.z) < 9)
            continue;
        EXPECT_NEAR(appleDistance({c * p.x - s * p.z, p.y, s * p.x + c * p.z}), 0, 0.01);
        ++compared;
    }
    EXPECT_GT(compared, mesh.positions.size() / 2);
    // Both ends are hollow: the skin on the axis lies deeper than the rims.
    const auto height = [&](double r, double way) {
        double y = 45 * way;
        while (appleDistance({0, y, r}) > 0)
            y -= 0.05 * way;
        return y;
    };
    EXPECT_GT(height(19, 1), height(5, 1) + 8);
    EXPECT_LT(height(14, -1), height(7.5, -1) - 1.5);
}

TEST(Apple, HollowAndThickKindsHaveTheirWalls) {
    for (const auto& [kind, wall] :
         {std::pair{AppleKind::hollow, kHollowWall}, std::pair{AppleKind::thick, kThickWall}}) {
        const auto mesh = meshSolid(appleSolid(kind), 12000);
        ASSERT_TRUE(mesh.ok());
        EXPECT_EQ(test::manifoldFault(*mesh), "");
        EXPECT_EQ(test::contacts(*mesh), 0u);
        const auto shells = test::shellsOf(*mesh);
        ASSERT_EQ(shells.size(), 2u);
        EXPECT_LT(shells[1].volume, 0);
        EXPECT_EQ(shells[1].genus, 0);
        // From the side inwards.
        const auto outer = test::rayHit(*mesh, {60, 3, 0.3}, {-1, 0, 0}, 0);
        ASSERT_TRUE(outer);
        const auto inner = test::rayHit(*mesh, {60, 3, 0.3}, {-1, 0, 0}, *outer + 1e-6);
        ASSERT_TRUE(inner);
        EXPECT_NEAR(*inner - *outer, wall, 0.1 * wall);
    }
}

} // namespace
} // namespace serosa::models
