// The tree against what is known without it: distances worked out by hand, brute force over all triangles,
// and the sphere. Ties go to the lowest index.
#include "sim/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace serosa::sim {
namespace {

struct Soup {
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> triangles;
};

/// A sphere of radius 1, of `rings` x 2 `rings` patches (poles are fans); all corners lie on the sphere.
Soup sphere(std::uint32_t rings) {
    Soup soup;
    const std::uint32_t columns = 2 * rings;
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t j = 0; j < columns; ++j) {
            const double polar = i == rings ? 0 : M_PI * i / rings, turn = 2 * M_PI * j / columns;
            soup.positions.push_back({std::sin(polar) * std::cos(turn), i == rings ? -1.0 : std::cos(polar),
                                      -std::sin(polar) * std::sin(turn)});
        }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < columns; ++j) {
            const std::uint32_t k = (j + 1) % columns;
            const std::uint32_t a = i * columns + j, b = (i + 1) * columns + j;
            const std::uint32_t c = (i + 1) * columns + k, d = i * columns + k;
            if (i + 1 < rings)
                soup.triangles.push_back({a, b, c});
            if (i > 0)
                soup.triangles.push_back({a, c, d});
        }
    return soup;
}

Soup randomSoup(std::size_t count, unsigned seed, double far) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto point = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
    Soup soup;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 centre = glm::dvec3(far) + point();
        for (int corner = 0; corner < 3; ++corner)
            soup.positions.push_back(centre + 0.2 * point());
        soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return soup;
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    EXPECT_LE(glm::length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

TEST(ClosestPointOnTriangle, FindsFaceEdgesAndCorners) {
    const glm::dvec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
    const auto at = [&](glm::dvec3 p) { return closestPointOnTriangle(p, a, b, c); };
    expectNear(at({1, 1, 5}).point, {1, 1, 0}, 1e-15);
    expectNear(at({1, 1, 5}).weights, {0.5, 0.25, 0.25}, 1e-15);
    expectNear(at({1, -3, 2}).point, {1, 0, 0}, 1e-15);
    expectNear(at({1, -3, 2}).weights, {0.75, 0.25, 0}, 1e-15);
    expectNear(at({-3, 3, 2}).weights, {0.25, 0, 0.75}, 1e-15);
    expectNear(at({4, 4, 1}).weights, {0, 0.5, 0.5}, 1e-15);
    expectNear(at({-1, -1, 1}).point, a, 0);
    expectNear(at({9, 1, 1}).point, b, 0);
    expectNear(at({1, 9, 1}).point, c, 0);
}

TEST(ClosestPointOnTriangle, ZeroAreaIsASegmentOrAPoint) {
    const glm::dvec3 a(0, 0, 0), b(1, 0, 0), c(3, 0, 0), p(2, 1, 0);
    for (const auto& [x, y, z] : {std::tuple{a, b, c}, {c, b, a}, {b, a, c}, {a, c, b}, {c, a, a}, {a, a, c}})
        expectNear(closestPointOnTriangle(p, x, y, z).point, {2, 0, 0}, 1e-15);
    expectNear(closestPointOnTriangle(p, b, b, b).point, b, 0);
}

TEST(ClosestPointOnTriangle, WeightsRebuildThePoint) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto point = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 a = point(), b = point(),
                         c = i % 4 ? point() : a + (b - a) * unit(random) + 1e-9 * point();
        const glm::dvec3 p = 2.0 * point();
        const TrianglePoint at = closestPointOnTriangle(p, a, b, c);
        EXPECT_NEAR(at.weights.x + at.weights.y + at.weights.z, 1, 1e-14);
        EXPECT_GE(std::min({at.weights.x, at.weights.y, at.weights.z}), 0);
        expectNear(at.weights.x * a + at.weights.y * b + at.weights.z * c, at.point, 1e-14);
        // No sample of the triangle is closer.
        double best = std::numeric_limits<double>::infinity();
        for (int u = 0; u <= 12; ++u)
            for (int v = 0; u + v <= 12; ++v)
                best = std::min(best, glm::length(p - (a + (b - a) * (u / 12.0) + (c - a) * (v / 12.0))));
        EXPECT_LE(glm::length(p - at.point), best + 1e-12);
    }
}

TEST(TriangleTree, EmptyFindsNothing) {
    const TriangleTree tree({}, {});
    EXPECT_FALSE(tree.closest({0, 0, 0}));
    EXPECT_EQ(tree.closest({0, 0, 0}).distance2, std::numeric_limits<double>::infinity());
    EXPECT_FALSE(tree.firstHit({0, 0, 0}, {0, 0, 1}, 10));
    tree.overlapping({-1, -1, -1}, {1, 1, 1}, [](std::uint32_t) { FAIL(); });
}

TEST(TriangleTree, ClosestEqualsBruteForce) {
    for (const double far : {0.0, 1500.0}) {
        const Soup soup = randomSoup(500, 3, far);
        const TriangleTree tree(soup.positions, soup.triangles);
        std::mt19937 random(4);
        std::uniform_real_distribution<double> unit(-2, 2);
        for (int i = 0; i < 500; ++i) {
            const glm::dvec3 p = glm::dvec3(far) + glm::dvec3(unit(random), unit(random), unit(random));
            std::uint32_t best = TriangleTree::kNone, bestOdd = TriangleTree::kNone;
            double distance2 = std::numeric_limits<double>::infinity(), distance2Odd = distance2;
            for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
                const glm::dvec3 offset =
                    p - closestPointOnTriangle(p, soup.positions[3 * t], soup.positions[3 * t + 1],
                                               soup.positions[3 * t + 2])
                            .point;
                const double d = glm::dot(offset, offset);
                if (d < distance2)
                    distance2 = d, best = t;
                if (t % 2 == 1 && d < distance2Odd)
                    distance2Odd = d, bestOdd = t;
            }
            const auto found = tree.closest(p);
            EXPECT_EQ(found.triangle, best);
            EXPECT_EQ(found.distance2, distance2);
            EXPECT_EQ(tree.closest(p, [](std::uint32_t t) { return t % 2 == 1; }).triangle, bestOdd);
            EXPECT_FALSE(tree.closest(p, [](std::uint32_t) { return false; }));
            EXPECT_FALSE(tree.closest(p, std::sqrt(distance2) * 0.999));
            EXPECT_EQ(tree.closest(p, std::sqrt(distance2) * 1.001).triangle, best);
        }
    }
}

TEST(TriangleTree, TiesGoToTheLowestIndex) {
    // Every corner and every edge of a sphere, asked for from outside: all triangles around it are equally
    // close.
    Soup soup = sphere(12);
    std::mt19937 random(5);
    std::shuffle(soup.triangles.begin(), soup.triangles.end(), random);
    const TriangleTree tree(soup.positions, soup.triangles);
    const std::uint32_t columns = 24;
    for (std::uint32_t vertex = columns; vertex < 12 * columns; ++vertex) {
        std::uint32_t lowest = TriangleTree::kNone;
        for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
            for (int corner = 0; corner < 3; ++corner)
                if (soup.triangles[t][corner] == vertex)
                    lowest = std::min(lowest, t);
        EXPECT_EQ(tree.closest(1.7 * soup.positions[vertex]).triangle, lowest);
    }
    // The edge of a roof, from above: both faces give the same bits, whatever the order of their corners.
    const std::vector<glm::dvec3> roof{{0.1, 0.3, 0.7}, {1.3, 0.9, 0.4}, {0.2, 2, -3}, {0.4, -2, -3}};
    for (const auto& faces :
         {std::vector<glm::uvec3>{{0, 1, 2}, {1, 0, 3}}, {{2, 1, 0}, {3, 0, 1}}, {{1, 2, 0}, {0, 3, 1}}})
        for (int i = 1; i < 100; ++i) {
            const glm::dvec3 p = roof[0] + (roof[1] - roof[0]) * (i / 100.0) + glm::dvec3(0, 0, 1 + 0.1 * i);
            EXPECT_EQ(TriangleTree(roof, faces).closest(p).triangle, 0u) << i;
        }
}

TEST(TriangleTree, OverlappingEqualsBruteForce) {
    const Soup soup = randomSoup(400, 9, 10);
    const TriangleTree tree(soup.positions, soup.triangles);
    for (int i = 0; i < 50; ++i) {
        const glm::dvec3 lowest = soup.positions[static_cast<std::size_t>(7 * i)],
                         highest = lowest + glm::dvec3(0.3);
        std::set<std::uint32_t> expected, found;
        for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
            const glm::dvec3* corner = &soup.positions[3 * t];
            bool apart = false;
            for (int axis = 0; axis < 3; ++axis)
                apart |= std::max({corner[0][axis], corner[1][axis], corner[2][axis]}) < lowest[axis] ||
                         std::min({corner[0][axis], corner[1][axis], corner[2][axis]}) > highest[axis];
            if (!apart)
                expected.insert(t);
        }
        tree.overlapping(lowest, highest, [&](std::uint32_t t) { EXPECT_TRUE(found.insert(t).second); });
        EXPECT_EQ(found, expected);
    }
}

TEST(TriangleTree, RaysMeetTheSphereWhereItIs) {
    const Soup soup = sphere(40);
    const TriangleTree tree(soup.positions, soup.triangles);
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 way = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const auto out = tree.firstHit({0, 0, 0}, 2.0 * way, 10);
        ASSERT_TRUE(out);
        EXPECT_NEAR(out->t, 0.5, 0.003); // chords of a sphere of 40 rings lie 0.2% within it
        EXPECT_FALSE(out->front);
        const glm::uvec3 t = soup.triangles[out->triangle];
        expectNear(out->weights.x * soup.positions[t.x] + out->weights.y * soup.positions[t.y] +
                       out->weights.z * soup.positions[t.z],
                   2.0 * way * out->t, 1e-14);
        const auto in = tree.firstHit(3.0 * way, -way, 10);
        ASSERT_TRUE(in);
        EXPECT_NEAR(in->t, 2, 0.004);
        EXPECT_TRUE(in->front);
        EXPECT_FALSE(tree.firstHit(3.0 * way, -way, 1.99));
        EXPECT_FALSE(tree.firstHit(3.0 * way, way, 10));
    }
}

TEST(TriangleTree, NoRaySlipsThroughAnEdgeOrACorner) {
    const Soup soup = sphere(16);
    const TriangleTree tree(soup.positions, soup.triangles);
    for (const auto& t : soup.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 a = soup.positions[t[corner]], b = soup.positions[t[(corner + 1) % 3]];
            for (const double share : {0.0, 0.3, 0.5}) {
                const glm::dvec3 aim = a + (b - a) * share;
                EXPECT_TRUE(tree.firstHit({0.01, 0.02, 0.03}, aim - glm::dvec3(0.01, 0.02, 0.03), 1.5));
            }
        }
}

TEST(TriangleTree, AxisParallelRaysThroughCornersOfBoxes) {
    // Two triangles of the square [0, 1] x [0, 1] at z = 1; the ray runs along its side and its diagonal.
    const TriangleTree tree({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {{0, 1, 2}, {0, 2, 3}});
    ASSERT_TRUE(tree.firstHit({0.5, 0.5, 0}, {0, 0, 1}, 1));
    EXPECT_EQ(tree.firstHit({0.5, 0.5, 0}, {0, 0, 1}, 1)->triangle, 0u); // both met at t = 1
    EXPECT_TRUE(tree.firstHit({0.5, 0, 0}, {0, 0, 2}, 1));
    EXPECT_FALSE(tree.firstHit({0.5, -1e-9, 0}, {0, 0, 2}, 1));
    EXPECT_FALSE(tree.firstHit({0.5, 0.5, 1}, {1, 0, 0}, 1)); // in its plane
    EXPECT_FALSE(tree.firstHit({0.5, 0.5, 0}, {0, 0, 0}, 1));
    int hits = 0;
    tree.allHits({0.5, 0.5, 0}, {0, 0, 1}, 2, [&](const TriangleTree::Hit&) { ++hits; });
    EXPECT_EQ(hits, 2);
}

TEST(TriangleTree, ManyEqualTrianglesStayQuick) {
    std::vector<glm::dvec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const TriangleTree tree(positions, std::vector<glm::uvec3>(5000, {0, 1, 2}));
    EXPECT_EQ(tree.closest({0.2, 0.2, 1}).triangle, 0u);
    EXPECT_EQ(tree.firstHit({0.2, 0.2, 1}, {0, 0, -1}, 2)->triangle, 0u);
}

TEST(TriangleTree, BindsFiftyThousandVerticesWellBelowASecond) {
    const Soup boundary = sphere(71); // about 20,000 triangles
    const auto start = std::chrono::steady_clock::now();
    const TriangleTree tree(boundary.positions, boundary.triangles);
    double sum = 0;
    for (int i = 0; i < 50000; ++i) { // a spiral over the sphere of radius 1.02
        const double y = 1 - (2 * i + 1) / 50000.0, radius = std::sqrt(1 - y * y);
        sum += tree.closest(1.02 * glm::dvec3(radius * std::cos(2.4 * i), y, radius * std::sin(2.4 * i)))
                   .distance2;
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    RecordProperty("seconds", std::to_string(taken.count()));
    EXPECT_NEAR(std::sqrt(sum / 50000), 0.02, 0.002);
    EXPECT_LT(taken.count(), 10.0); // 0.1 s in release; the bound only has to catch a search of all triangles
}

} // namespace
} // namespace serosa::sim
