// The sampled distance to a closed mesh against closed forms.
#include "sim/distance_field.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace serosa;
using sim::DistanceField;

namespace {

glm::dvec3 randomPoint(std::mt19937& random, double size) {
    const auto one = [&] { return size * (double(random()) / 2147483648.0 - 1); };
    const double x = one(), y = one(), z = one();
    return {x, y, z};
}

double boxDistance(const glm::dvec3& p, const glm::dvec3& half) {
    const glm::dvec3 out = glm::abs(p) - half;
    return glm::length(glm::max(out, glm::dvec3(0))) + std::min(0.0, std::max({out.x, out.y, out.z}));
}

} // namespace

TEST(DistanceField, ofABallIsItsOwn) {
    const double radius = 0.01;
    const DistanceField field(test::ballMesh(radius, 5));
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 p = randomPoint(random, 1.05 * radius);
        EXPECT_NEAR(field.sample(p).distance, glm::length(p) - radius, 0.01 * radius) << glm::length(p);
        if (glm::length(p) > 0.3 * radius) {
            EXPECT_LT(glm::distance(field.sample(p).normal, glm::normalize(p)), 0.08);
        }
    }
    EXPECT_NEAR(field.thinnestHalfWidth(), radius, 0.02 * radius);
}

TEST(DistanceField, ofABoxIsWithinASampleAndOutsideNoMore) {
    const glm::dvec3 half(0.01, 0.004, 0.002);
    const DistanceField field(test::boxMesh(-half, half));
    EXPECT_LE(std::max({field.dims().x, field.dims().y, field.dims().z}), DistanceField::kMostSamples);
    std::mt19937 random(5);
    for (int i = 0; i < 4000; ++i) {
        const bool far = i % 2; // beyond the grid
        const glm::dvec3 p =
            far ? randomPoint(random, 0.05) : randomPoint(random, 1) * (half + 1.5 * field.step());
        const double got = field.sample(p).distance, exact = boxDistance(p, half);
        EXPECT_LT(got, exact + 0.5 * field.step());
        EXPECT_GT(got, far ? 0.9 * exact - field.step() : exact - 0.9 * field.step());
        EXPECT_LT(field.lowerBound(p), exact + 0.5 * field.step());
        if (std::abs(exact) > field.step()) {
            EXPECT_EQ(got < 0, exact < 0);
        }
    }
    EXPECT_NEAR(field.thinnestHalfWidth(), half.z, 1e-4 * half.z);
}

// Not convex: a pair of bars. No bound may be more than the distance.
TEST(DistanceField, lowerBoundHoldsForWhatIsNotConvex) {
    sim::TriangleMesh bars = test::boxMesh({-0.01, -0.01, -0.001}, {-0.008, 0.01, 0.001});
    test::append(bars, test::boxMesh({0.008, -0.01, -0.001}, {0.01, 0.01, 0.001}), false);
    const DistanceField field(bars);
    std::mt19937 random(9);
    double worst = 0;
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec3 p = randomPoint(random, 0.04);
        const double exact = std::min(boxDistance(p - glm::dvec3(-0.009, 0, 0), {0.001, 0.01, 0.001}),
                                      boxDistance(p - glm::dvec3(0.009, 0, 0), {0.001, 0.01, 0.001}));
        EXPECT_LT(field.lowerBound(p), exact + 0.5 * field.step());
        worst = std::max(worst, field.sample(p).distance / std::max(exact, field.step()));
    }
    EXPECT_LT(worst, 1.42);
}

TEST(DistanceField, isContinuousWhereTheGridEnds) {
    const DistanceField field(test::ballMesh(0.01, 4), 24);
    const glm::dvec3 top = field.lowest() + field.step() * glm::dvec3(field.dims() - 1);
    for (const double y : {-0.003, 0.0, 0.007}) {
        const double within = field.sample({top.x - 1e-9, y, 0.002}).distance,
                     beyond = field.sample({top.x + 1e-9, y, 0.002}).distance;
        EXPECT_NEAR(within, beyond, 1e-8);
    }
}
