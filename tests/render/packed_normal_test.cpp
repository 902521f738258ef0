#include "sim/packed_normal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace serosa::sim {
namespace {

TEST(PackedNormal, RandomDirectionsReturnAndAreOrdinaryFloats) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    double worst = 0;
    for (int i = 0; i < 200'000; ++i) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const std::uint32_t bits = packNormal(glm::vec3(n));
        float alpha = 0;
        std::memcpy(&alpha, &bits, sizeof alpha);
        ASSERT_TRUE(std::isnormal(alpha)) << std::hex << bits;
        ASSERT_EQ(bits >> 30 & 1U, 0U); // a spare bit for those who pack more
        const glm::dvec3 back(unpackNormal(bits));
        ASSERT_NEAR(glm::length(back), 1, 1e-6);
        worst = std::max(worst, glm::length(glm::cross(n, back)));
    }
    EXPECT_LE(worst, 1.35e-4);
    EXPECT_GE(worst, 1e-5); // else 15 bits were not what was tested
}

TEST(PackedNormal, LatticeDirectionsAreExact) {
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x || y || z) {
                    const glm::dvec3 n = glm::normalize(glm::dvec3(x, y, z));
                    EXPECT_LE(glm::distance(glm::dvec3(unpackNormal(packNormal(glm::vec3(n)))), n), 2e-7);
                }
}

TEST(PackedNormal, LengthDoesNotMatterAndZeroPointsUp) {
    EXPECT_EQ(packNormal({0.3F, -2.0F, 7.0F}), packNormal({0.15F, -1.0F, 3.5F}));
    EXPECT_EQ(unpackNormal(packNormal(glm::vec3(0))), glm::vec3(0, 1, 0));
}

} // namespace
} // namespace serosa::sim
