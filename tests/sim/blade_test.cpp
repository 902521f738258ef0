// The predicate against answers that are known without it: exact rational arithmetic for planar patches,
// sampling for twisted ones, and places where blade and spring only touch.
#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/blade.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace serosa;
using sim::LatticeStroke;

namespace {

LatticeStroke blade(const glm::vec3& a0, const glm::vec3& b0, const glm::vec3& a1, const glm::vec3& b1) {
    LatticeStroke stroke;
    stroke.corners = {a0, b0, a1, b1};
    return stroke;
}

glm::vec3 randomPoint(std::mt19937& random, int steps) {
    const auto one = [&] { return float(int(random() % unsigned(2 * steps + 1)) - steps) / 4.0f; };
    const float x = one(), y = one(), z = one();
    return {x, y, z};
}

// Coordinates of randomPoint are quarters: in fourths everything is a small integer, and integers are exact.
using Exact = __int128;
struct Vec {
    Exact x, y, z;
};
Vec exact(const glm::vec3& v) {
    return {Exact(std::lround(v.x * 4)), Exact(std::lround(v.y * 4)), Exact(std::lround(v.z * 4))};
}
Vec operator-(const Vec& a, const Vec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec cross(const Vec& a, const Vec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Exact dot(const Vec& a, const Vec& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
int sign(Exact e) {
    return e > 0 ? 1 : e < 0 ? -1 : 0;
}
int orient(const Vec& a, const Vec& b, const Vec& c, const Vec& d) {
    return sign(dot(b - a, cross(c - a, d - a)));
}

/// In the plane across `axis`: does segment pq meet segment ab?
bool segmentsMeet2(const Vec& p, const Vec& q, const Vec& a, const Vec& b, const Vec& normal) {
    const auto side = [&](const Vec& u, const Vec& v, const Vec& w) {
        return sign(dot(cross(v - u, w - u), normal));
    };
    const int s1 = side(p, q, a), s2 = side(p, q, b), s3 = side(a, b, p), s4 = side(a, b, q);
    if (s1 * s2 < 0 && s3 * s4 < 0)
        return true;
    const auto on = [](const Vec& u, const Vec& v, const Vec& w) { // w on uv, the three on one line
        return dot(u - w, v - w) <= 0;
    };
    return (s1 == 0 && on(p, q, a)) || (s2 == 0 && on(p, q, b)) || (s3 == 0 && on(a, b, p)) ||
           (s4 == 0 && on(a, b, q));
}

bool inTriangle(const Vec& p, const Vec& a, const Vec& b, const Vec& c, const Vec& normal) {
    const int s1 = sign(dot(cross(b - a, p - a), normal)), s2 = sign(dot(cross(c - b, p - b), normal)),
              s3 = sign(dot(cross(a - c, p - c), normal));
    return (s1 >= 0 && s2 >= 0 && s3 >= 0) || (s1 <= 0 && s2 <= 0 && s3 <= 0);
}

/// Closed segment against closed triangle, exactly. The triangle has an area.
bool meetsTriangle(const Vec& p, const Vec& q, const Vec& a, const Vec& b, const Vec& c) {
    const Vec normal = cross(b - a, c - a);
    const int sp = orient(a, b, c, p), sq = orient(a, b, c, q);
    if (sp * sq > 0)
        return false;
    if (sp == 0 && sq == 0)
        return inTriangle(p, a, b, c, normal) || segmentsMeet2(p, q, a, b, normal) ||
               segmentsMeet2(p, q, b, c, normal) || segmentsMeet2(p, q, c, a, normal);
    if (sp == 0)
        return inTriangle(p, a, b, c, normal);
    if (sq == 0)
        return inTriangle(q, a, b, c, normal);
    const int s1 = orient(p, q, a, b), s2 = orient(p, q, b, c), s3 = orient(p, q, c, a);
    return (s1 >= 0 && s2 >= 0 && s3 >= 0) || (s1 <= 0 && s2 <= 0 && s3 <= 0);
}

glm::dvec3 onPatch(const LatticeStroke& s, double u, double v) {
    const glm::dvec3 a = glm::mix(glm::dvec3(s.corners[0]), glm::dvec3(s.corners[2]), v),
                     b = glm::mix(glm::dvec3(s.corners[1]), glm::dvec3(s.corners[3]), v);
    return glm::mix(a, b, u);
}

} // namespace

TEST(Blade, agreesWithExactArithmeticOnParallelograms) {
    std::mt19937 random(11);
    int crossed = 0, total = 0;
    for (int i = 0; i < 200000; ++i) {
        const glm::vec3 a0 = randomPoint(random, 6), b0 = randomPoint(random, 6), a1 = randomPoint(random, 6),
                        b1 = a1 + (b0 - a0), p = randomPoint(random, 6), q = randomPoint(random, 6);
        const Vec n = cross(exact(b0) - exact(a0), exact(a1) - exact(a0));
        if (p == q || dot(n, n) == 0)
            continue;
        const bool expected = meetsTriangle(exact(p), exact(q), exact(a0), exact(b0), exact(b1)) ||
                              meetsTriangle(exact(p), exact(q), exact(a0), exact(b1), exact(a1));
        ASSERT_EQ(sim::strokeCuts(blade(a0, b0, a1, b1), p, q, 1), expected) << i;
        crossed += expected;
        ++total;
    }
    EXPECT_GT(crossed, total / 50);
    EXPECT_LT(crossed, total / 2);
}

TEST(Blade, twistedPatchesAreNotTwoTriangles) {
    // z = x y over the unit square, and its two triangulations, which miss it by up to 1/4.
    const LatticeStroke saddle = blade({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1});
    const glm::vec3 below(0.5f, 0.5f, -1), at(0.5f, 0.5f, 0.25f), above(0.5f, 0.5f, 1);
    EXPECT_TRUE(sim::strokeCuts(saddle, below, at, 1)); // ends on it
    EXPECT_TRUE(sim::strokeCuts(saddle, at, above, 1));
    EXPECT_FALSE(
        sim::strokeCuts(saddle, below, {0.5f, 0.5f, 0.2499f}, 1)); // crosses a triangle, not the patch
    EXPECT_FALSE(sim::strokeCuts(saddle, {0.5f, 0.5f, 0.2501f}, above, 1));
    EXPECT_TRUE(sim::strokeCuts(saddle, {0.5f, 0.5f, 0.2501f}, {0.5f, 0.5f, 0.2499f}, 1));
    // Both ends on one side, through the saddle's middle twice: parity would call it apart.
    EXPECT_TRUE(sim::strokeCuts(saddle, {0.0f, 1.0f, 0.125f}, {1.0f, 0.0f, 0.125f}, 2));
}

TEST(Blade, cutsWhatSamplingFindsOnTwistedPatches) {
    std::mt19937 random(12);
    int crossed = 0;
    for (int i = 0; i < 4000; ++i) {
        const LatticeStroke stroke = blade(randomPoint(random, 8), randomPoint(random, 8),
                                           randomPoint(random, 8), randomPoint(random, 8));
        // A segment through a point of the patch, and the same one moved until it clears all samples.
        const double u = double(random() % 1001) / 1000, v = double(random() % 1001) / 1000;
        const glm::dvec3 hit = onPatch(stroke, u, v), along = glm::dvec3(randomPoint(random, 4));
        const glm::vec3 p(hit - 0.3 * along), q(hit + 0.6 * along);
        // Rounding p and q to float32 moves the line by 1e-7: count it where a nearby sample lies that close.
        if (u > 1e-4 && u < 1 - 1e-4 && v > 1e-4 && v < 1 - 1e-4) {
            const glm::dvec3 du = onPatch(stroke, 1, v) - onPatch(stroke, 0, v),
                             dv = onPatch(stroke, u, 1) - onPatch(stroke, u, 0);
            if (std::abs(glm::dot(along, glm::cross(du, dv))) > 0.05) {
                EXPECT_TRUE(sim::strokeCuts(stroke, p, q, 1)) << i;
                ++crossed;
            }
        }
        // Apart from every sample by more than the samples' spacing: certainly apart.
        const glm::vec3 r = randomPoint(random, 10), s = r + 0.5f * randomPoint(random, 4);
        constexpr int kSamples = 24;
        double nearest = 1e30, spacing = 0;
        for (int a = 0; a <= kSamples; ++a)
            for (int b = 0; b <= kSamples; ++b) {
                const glm::dvec3 x = onPatch(stroke, double(a) / kSamples, double(b) / kSamples);
                const glm::dvec3 d = glm::dvec3(s) - glm::dvec3(r);
                const double length2 = glm::dot(d, d);
                const double t =
                    length2 > 0 ? std::clamp(glm::dot(x - glm::dvec3(r), d) / length2, 0.0, 1.0) : 0;
                nearest = std::min(nearest, glm::length(x - (glm::dvec3(r) + t * d)));
            }
        for (int k = 0; k < 4; ++k)
            for (int m = 0; m < k; ++m)
                spacing = std::max(spacing, double(glm::length(stroke.corners[std::size_t(k)] -
                                                               stroke.corners[std::size_t(m)])));
        if (nearest > 2 * spacing / kSamples) {
            EXPECT_FALSE(sim::strokeCuts(stroke, r, s, 1)) << i;
        }
    }
    EXPECT_GT(crossed, 2000);
}

TEST(Blade, touchingCountsAsCrossed) {
    const LatticeStroke square = blade({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0});
    EXPECT_TRUE(sim::strokeCuts(square, {1, 1, 0}, {1, 1, 1}, 1));    // an end on it
    EXPECT_TRUE(sim::strokeCuts(square, {0, 0, -1}, {0, 0, 0}, 1));   // on its corner
    EXPECT_TRUE(sim::strokeCuts(square, {1, 0, -1}, {1, 0, 1}, 1));   // through its edge
    EXPECT_TRUE(sim::strokeCuts(square, {0, 1, 0}, {1, 1, 0}, 1));    // in it
    EXPECT_TRUE(sim::strokeCuts(square, {-1, 0, 0}, {0, 0, 0}, 1));   // in its plane, touching
    EXPECT_FALSE(sim::strokeCuts(square, {-2, 1, 0}, {-1, 1, 0}, 1)); // in its plane, apart
    EXPECT_FALSE(sim::strokeCuts(square, {3, 1, 0}, {1, 3.5f, 0}, 1));
    EXPECT_FALSE(sim::strokeCuts(square, {1, 1, 1e-6f}, {1, 1, 1}, 1));
    EXPECT_FALSE(sim::strokeCuts(square, {2.000001f, 1, -1}, {2.000001f, 1, 1}, 1));
}

TEST(Blade, sweepsAndEdgesWithoutLength) {
    const LatticeStroke line = blade({0, 0, 0}, {2, 0, 0}, {0, 0, 0}, {2, 0, 0}); // no sweep
    EXPECT_TRUE(sim::strokeCuts(line, {1, -1, 0}, {1, 1, 0}, 1));
    EXPECT_TRUE(sim::strokeCuts(line, {-1, 0, 0}, {0, 0, 0}, 1));
    EXPECT_FALSE(sim::strokeCuts(line, {1, -1, 1e-5f}, {1, 1, 1e-5f}, 1));
    EXPECT_FALSE(sim::strokeCuts(line, {-2, 0, 0}, {-1, 0, 0}, 1));                 // on its line
    EXPECT_FALSE(sim::strokeCuts(line, {0, 1, 0}, {2, 1, 0}, 1));                   // parallel
    const LatticeStroke needle = blade({0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 0, 0}); // no edge
    EXPECT_TRUE(sim::strokeCuts(needle, {1, -1, 0}, {1, 1, 0}, 1));
    EXPECT_FALSE(sim::strokeCuts(needle, {3, -1, 0}, {3, 1, 0}, 1));
    const LatticeStroke point = blade({1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}); // neither
    EXPECT_TRUE(sim::strokeCuts(point, {0, 0, 0}, {2, 0, 0}, 1));
    EXPECT_FALSE(sim::strokeCuts(point, {0, 0, 0}, {0.5f, 0, 0}, 1));
    EXPECT_FALSE(sim::strokeCuts(point, {0, 1, 0}, {2, 1, 0}, 1));
    const LatticeStroke fan = blade({0, 0, 0}, {2, 0, 0}, {0, 0, 0}, {2, 2, 0}); // turns about one end
    EXPECT_TRUE(sim::strokeCuts(fan, {1.5f, 0.5f, -1}, {1.5f, 0.5f, 1}, 1));
    EXPECT_FALSE(sim::strokeCuts(fan, {0.5f, 1.5f, -1}, {0.5f, 1.5f, 1}, 1));
}

TEST(Blade, ballsAndStrains) {
    LatticeStroke ball;
    ball.kind = sim::StrokeKind::cauterize;
    ball.size = 1;
    EXPECT_TRUE(sim::strokeCuts(ball, {-3, 0.5f, 0}, {3, 0.5f, 0}, 1)); // both ends outside
    EXPECT_TRUE(sim::strokeCuts(ball, {-3, 1, 0}, {3, 1, 0}, 1));       // touches
    EXPECT_FALSE(sim::strokeCuts(ball, {-3, 1.0001f, 0}, {3, 1.0001f, 0}, 1));
    EXPECT_FALSE(sim::strokeCuts(ball, {1.5f, 0, 0}, {2.5f, 0, 0}, 1));
    EXPECT_TRUE(sim::strokeCuts(ball, {0.5f, 0, 0}, {2.5f, 0, 0}, 1));
    const sim::Lattice cell = test::blockLattice(1, 1, 1);
    sim::Stroke tear;
    tear.kind = sim::StrokeKind::tear;
    tear.strain = 0.5;
    const LatticeStroke limit = sim::toLattice(tear, cell);
    EXPECT_FALSE(sim::strokeCuts(limit, {0, 0, 0}, {1.5f, 0, 0}, 1));
    EXPECT_TRUE(sim::strokeCuts(limit, {0, 0, 0}, {1.501f, 0, 0}, 1));
    EXPECT_FALSE(sim::strokeCuts(limit, {0, 0, 0}, {1.5f, 1.45f, 0}, 2));
    EXPECT_TRUE(sim::strokeCuts(limit, {0, 0, 0}, {1.51f, 1.5f, 0}, 2));
}

TEST(Blade, directionsFollowTheNodeOrder) {
    const sim::Lattice lattice = test::blockLattice(3, 3, 3);
    std::uint32_t bits = 0;
    for (int d = 0; d < 18; ++d)
        bits |= std::uint32_t(sim::leadsToHigherIndex(d)) << d;
    EXPECT_EQ(bits, SRS_HIGHER_DIRECTIONS);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; ++d)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                EXPECT_EQ(std::size_t(other) > node, sim::leadsToHigherIndex(d));
            }
}
