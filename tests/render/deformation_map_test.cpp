// Closed-form deformations: forward then inverse, Jacobians against finite differences, faces where nothing
// moves, and what is known of each.
#include "render/deformation_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace serosa::render {
namespace {

DeformationMap mapOf(MapKind kind) {
    DeformationMap map;
    map.kind = kind;
    map.half = {0.05, 0.06, 0.04};
    switch (kind) {
    case MapKind::twist:
        map.amount = 0.8;
        break;
    case MapKind::bend:
        map.amount = 1.1;
        map.extent = 0.07;
        break;
    case MapKind::pull:
        map.amount = 0.05;
        map.radius = 0.012;
        break;
    case MapKind::wave:
        map.amount = 0.01;
        map.extent = 0.03;
        break;
    case MapKind::peel:
        map.amount = -0.02;
        map.radius = 0.02;
        map.depth = 0.108;
        map.width = 0.05;
        break;
    case MapKind::knife:
    case MapKind::seam:
        map.amount = 0.008;
        map.depth = 0.05;
        map.extent = 0.06;
        break;
    case MapKind::incision:
        map.amount = 0.005;
        map.depth = 0.05;
        map.width = 0.03;
        map.path = {{-0.03, -0.02}, {0.03, 0.015}}; // inside of a bend D jumps
        break;
    default:
        break;
    }
    return map;
}

const MapKind kAll[] = {MapKind::twist, MapKind::bend,  MapKind::pull, MapKind::wave,
                        MapKind::peel,  MapKind::knife, MapKind::seam, MapKind::incision};

class Points {
public:
    explicit Points(const DeformationMap& map) : map_(map) {}
    glm::dvec3 next() {
        const auto number = [this] { return 2.0 * double(engine_()) / 4294967296.0 - 1.0; };
        const double x = number(), y = number(), z = number();
        return glm::dvec3(x, y, z) * map_.half;
    }

private:
    const DeformationMap& map_;
    std::mt19937 engine_{7};
};

class EveryMap : public ::testing::TestWithParam<MapKind> {};

TEST_P(EveryMap, ForwardThenInverseReturns) {
    const DeformationMap map = mapOf(GetParam());
    ASSERT_EQ(problemOf(map), "");
    Points points(map);
    int moved = 0;
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 p = points.next(), shown = forward(map, p);
        if (kept(map, shown) < 1e-9) // on a cut, or under a flap
            continue;
        moved += glm::distance(p, shown) > 1e-4;
        ASSERT_LT(glm::distance(shown + inverseDisplacement(map, shown), p), 1e-9) << i;
    }
    EXPECT_GT(moved, 100);
}

TEST_P(EveryMap, JacobianIsThatOfFiniteDifferences) {
    const DeformationMap map = mapOf(GetParam());
    Points points(map);
    const double step = 1e-7;
    int compared = 0;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 p = points.next();
        if (kept(map, p) < 1e-4) // in a gap, beside a jump
            continue;
        const glm::dmat3 jacobian = inverseJacobian(map, p);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 by(0);
            by[axis] = step;
            const auto restOf = [&](const glm::dvec3& q) { return q + inverseDisplacement(map, q); };
            const glm::dvec3 two = restOf(p + by), one = restOf(p - by), here = restOf(p);
            // Where a formula has a corner (the end of a range), the two sides differ: left out.
            if (glm::distance(two - here, here - one) > 1e-4 * step)
                continue;
            ++compared;
            EXPECT_LT(glm::distance(jacobian[axis], (two - one) / (2 * step)), 2e-5) << "axis " << axis;
        }
    }
    EXPECT_GT(compared, 3000);
}

TEST_P(EveryMap, IsZeroOnTheFacesThatItSays) {
    const DeformationMap map = mapOf(GetParam());
    const BoxFaces faces = zeroFaces(map);
    Points points(map);
    for (int face = 0; face < 6; ++face) {
        double most = 0;
        for (int i = 0; i < 2000; ++i) {
            glm::dvec3 p = points.next();
            p[face / 2] = (face % 2 == 0 ? -1 : 1) * map.half[face / 2];
            most = std::max({most, glm::length(inverseDisplacement(map, p)), -kept(map, p)});
        }
        EXPECT_EQ(faces.zero[face], most < 1e-12) << "face " << face << ": " << most;
    }
}

INSTANTIATE_TEST_SUITE_P(Maps, EveryMap, ::testing::ValuesIn(kAll),
                         [](const auto& tested) { return std::string(nameOf(tested.param)); });

// CS07 prints D = -D_F for a twist: at 30 degrees the point is then off by |R(a)(2 - R(a)) - 1| of its
// radius.
TEST(DeformationMap, TwistIsNotTheNegativeForwardDisplacement) {
    DeformationMap map = mapOf(MapKind::twist);
    map.amount = std::numbers::pi / 6;
    const glm::dvec3 p(0.01, map.half.y, 0);
    const glm::dvec3 shown = forward(map, p);
    EXPECT_NEAR(shown.x, 0.01 * std::cos(map.amount), 1e-12);
    EXPECT_NEAR(shown.z, -0.01 * std::sin(map.amount), 1e-12);
    const glm::dvec3 asPrinted = shown - (forward(map, shown) - shown);
    EXPECT_NEAR(glm::distance(asPrinted, p) / 0.01, 0.268, 0.001);
    EXPECT_LT(glm::distance(shown + inverseDisplacement(map, shown), p), 1e-15);
}

TEST(DeformationMap, BendIsBarrs) {
    const DeformationMap map = mapOf(MapKind::bend);
    // The middle line keeps its length, and turns by the whole angle.
    glm::dvec3 last = forward(map, {0, -0.035, 0});
    double length = 0;
    for (int i = 1; i <= 2000; ++i) {
        const glm::dvec3 next = forward(map, {0, -0.035 + 0.07 * i / 2000, 0});
        length += glm::distance(last, next);
        last = next;
    }
    EXPECT_NEAR(length, 0.07, 1e-8);
    const glm::dvec3 on = glm::normalize(forward(map, {0, 0.05, 0}) - last);
    EXPECT_NEAR(std::atan2(on.x, on.y), 1.1, 1e-9);
}

TEST(DeformationMap, ACutIsAsWideAsItSays) {
    for (const MapKind kind : {MapKind::knife, MapKind::seam}) {
        const DeformationMap map = mapOf(kind);
        const double z = kind == MapKind::knife ? 0 : map.half.z;
        EXPECT_NEAR(kept(map, {0.008, map.half.y, z}), 0, 1e-12) << nameOf(kind);
        EXPECT_NEAR(kept(map, {0, map.half.y, z}), -0.008, 1e-12);
        EXPECT_GT(kept(map, {0.0, map.half.y - 1.01 * map.depth, z}), 0) << "below it";
        EXPECT_NEAR(forward(map, {1e-15, map.half.y, z}).x, 0.008, 1e-12);
    }
}

// A straight path along z is the knife's cut, but for where tissue gives way; a round one opens along itself.
TEST(DeformationMap, AnIncisionFollowsItsPath) {
    DeformationMap knife = mapOf(MapKind::knife), straight = mapOf(MapKind::incision);
    straight.amount = knife.amount;
    straight.depth = knife.depth;
    straight.width = 2 * knife.half.x;
    straight.path = {{0, -0.03}, {0, 0.03}};
    Points points(knife);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 p = points.next();
        if (std::abs(p.z) > 0.03)
            continue;
        EXPECT_LT(glm::distance(inverseDisplacement(straight, p), inverseDisplacement(knife, p)), 1e-12);
        EXPECT_NEAR(kept(straight, p) < 0, kept(knife, p) < 0, 0);
    }
    DeformationMap round = straight;
    round.width = 0.02;
    round.path.clear();
    for (int i = 0; i <= 32; ++i) {
        const double angle = std::numbers::pi * i / 32;
        round.path.push_back({0.025 * std::cos(angle), 0.025 * std::sin(angle) - 0.01});
    }
    ASSERT_EQ(problemOf(round), "");
    const double on = 0.025 - 0.01; // the middle of the path, on +z
    EXPECT_NEAR(kept(round, {0, round.half.y, on}), -round.amount, 1e-4);
    EXPECT_NEAR(kept(round, {0, round.half.y, on + round.amount}), 0, 1e-4);
    EXPECT_NEAR(forward(round, {0, round.half.y, on + 1e-9}).z, on + round.amount, 1e-4);
    EXPECT_NEAR(forward(round, {0, round.half.y, on - 1e-9}).z, on - round.amount, 1e-4);
    round.path.push_back({1, 1});
    EXPECT_NE(problemOf(round).find("leaves"), std::string::npos);
}

TEST(DeformationMap, SolidsAreCutAway) {
    DeformationMap ball;
    ball.half = {0.05, 0.06, 0.04};
    ball.kind = MapKind::sphere;
    ball.radius = 0.03;
    EXPECT_EQ(inverseDisplacement(ball, {0.01, 0, 0}), glm::dvec3(0));
    EXPECT_NEAR(kept(ball, {0, 0.05, 0}), 0.02, 1e-15);
    EXPECT_NEAR(kept(ball, {0, 0.01, 0}), -0.02, 1e-15);
    DeformationMap box = ball;
    box.kind = MapKind::box;
    box.extent = 0.06;
    box.depth = 0.02;
    box.width = 0.09; // wider than the box of the map: its z faces are not still
    EXPECT_NEAR(kept(box, {0, 0.005, 0}), -0.005, 1e-15);
    EXPECT_NEAR(kept(box, {0.034, 0.013, 0}), 0.005, 1e-15) << "3, 4, 5 from its edge";
    EXPECT_TRUE(zeroFaces(box).zero[0]);
    EXPECT_FALSE(zeroFaces(box).zero[4]);
    box.width = 0;
    EXPECT_NE(problemOf(box), "");
}

TEST(DeformationMap, APeelBaresTheGround) {
    const DeformationMap map = mapOf(MapKind::peel);
    const double ground = -map.half.y + map.depth;
    EXPECT_LT(kept(map, {0.03, ground + 0.001, 0.0}), 0) << "the layer's empty place";
    EXPECT_GT(kept(map, {0.03, ground - 0.001, 0.0}), 0) << "its ground";
    EXPECT_GT(kept(map, {-0.03, ground + 0.001, 0.0}), 0) << "not yet peeled";
    EXPECT_GT(kept(map, {0.03, ground + 0.001, 0.03}), 0) << "beside it";
    const glm::dvec3 rolled = forward(map, {-0.02 + 0.02 * std::numbers::pi / 2, ground + 0.005, 0});
    EXPECT_NEAR(rolled.x, -0.02 + 0.015, 1e-12) << "a quarter turn: upright";
    EXPECT_NEAR(rolled.y, ground + 0.02, 1e-12);
}

TEST(DeformationMap, WhatFoldsIsSaid) {
    DeformationMap map = mapOf(MapKind::pull);
    map.amount = 0.09;
    EXPECT_NE(problemOf(map).find("folds"), std::string::npos);
    map = mapOf(MapKind::bend);
    map.amount = 6;
    EXPECT_NE(problemOf(map), "");
    map = mapOf(MapKind::knife);
    map.amount = 0.06;
    EXPECT_NE(problemOf(map), "");
    map = mapOf(MapKind::peel);
    map.radius = 0;
    EXPECT_NE(problemOf(map), "");
    EXPECT_EQ(parseMapKind("peel"), MapKind::peel);
    EXPECT_FALSE(parseMapKind("pe"));
}

} // namespace
} // namespace serosa::render
