// The heart phantom as a surgeon or a mesh checker would measure it: on the mesh, not on the functions that
// made it.
#include "mesh_measures.h"
#include "models/heart.h"
#include "models/phantom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

namespace serosa::models {
namespace {

constexpr std::size_t kFaces = 30000;

const sim::TriangleMesh& heart() {
    static const sim::TriangleMesh mesh = makePhantom("heart", kFaces).value();
    return mesh;
}

TEST(Heart, IsOneSoundSolidWithTwoCavities) {
    EXPECT_GE(heart().faces.size(), kFaces);
    EXPECT_LE(static_cast<double>(heart().faces.size()), 1.05 * kFaces);
    EXPECT_EQ(heart().colours.size(), heart().positions.size());
    EXPECT_EQ(test::manifoldFault(heart()), "");
    EXPECT_EQ(test::contacts(heart()), 0u);
    EXPECT_GT(test::leastAngle(heart()), 10.0);
    const auto shells = test::shellsOf(heart());
    ASSERT_EQ(shells.size(), 3u);
    EXPECT_GT(shells[0].volume, 0);
    // Handles: a lumen with n openings makes n - 1 (right atrium 2, left atrium 4, aorta 4, pulmonary trunk
    // 2).
    EXPECT_EQ(shells[0].genus, 8);
    for (int cavity : {1, 2}) {
        EXPECT_EQ(shells[static_cast<std::size_t>(cavity)].genus, 0);
        EXPECT_LT(shells[static_cast<std::size_t>(cavity)].volume, -30e3); // ventricles of 30 to 100 ml
        EXPECT_GT(shells[static_cast<std::size_t>(cavity)].volume, -100e3);
    }
}

TEST(Heart, WallsMeasuredOnTheMeshAreAsStated) {
    std::set<std::string> walls;
    for (const WallProbe& probe : heartWallProbes()) {
        walls.insert(probe.wall);
        // Onto the mesh from outside, then to the wall's other face.
        const glm::dvec3 from = probe.outerPoint - 1.0 * probe.inward;
        const auto outer = test::rayHit(heart(), from, probe.inward, 0.0);
        ASSERT_TRUE(outer) << probe.wall;
        EXPECT_NEAR(*outer, 1.0, 0.35) << probe.wall << ": the outer face is not where the probe is";
        const auto inner = test::rayHit(heart(), from, probe.inward, *outer + 1e-6);
        ASSERT_TRUE(inner) << probe.wall;
        EXPECT_NEAR(*inner - *outer, probe.expected, 0.15 * probe.expected) << probe.wall;
    }
    EXPECT_EQ(walls.size(), 7u);
}

/// Material along one line of the section: where it enters and leaves, sorted.
std::vector<double> crossings(const glm::dvec3& from, const glm::dvec3& direction) {
    std::vector<double> out;
    for (const auto& f : heart().faces) {
        const glm::dvec3 a = heart().positions[f.x], e1 = heart().positions[f.y] - a,
                         e2 = heart().positions[f.z] - a, h = glm::cross(direction, e2);
        const double det = glm::dot(e1, h);
        const glm::dvec3 s = from - a, c = glm::cross(s, e1);
        const double u = glm::dot(s, h) / det, v = glm::dot(direction, c) / det;
        if (u >= 0 && v >= 0 && u + v < 1)
            out.push_back(glm::dot(e2, c) / det);
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST(Heart, SectionThroughTheApexShowsFourChambers) {
    const HeartSection plane = heartFourChamberSection();
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), plane.normal));
    const glm::dvec3 up = glm::cross(plane.normal, right);
    constexpr int n = 100;
    constexpr double step = 1.6; // mm
    const glm::dvec3 corner = plane.on - 0.5 * n * step * (right + up) - 20.0 * right + 40.0 * up;
    std::vector<int> region(n * n, 0); // -1 material, 0 not yet seen, else a region
    for (int y = 0; y < n; ++y) {
        const glm::dvec3 from = corner + (y * step + 0.013) * up;
        const auto cuts = crossings(from, right);
        EXPECT_EQ(cuts.size() % 2, 0u);
        for (int x = 0; x < n; ++x) {
            const auto before = std::lower_bound(cuts.begin(), cuts.end(), x * step) - cuts.begin();
            region[static_cast<std::size_t>(y * n + x)] = before % 2 ? -1 : 0;
        }
    }
    std::vector<int> area{0};
    for (int seed = 0; seed < n * n; ++seed) {
        if (region[static_cast<std::size_t>(seed)] != 0)
            continue;
        const int id = static_cast<int>(area.size());
        area.push_back(0);
        std::vector<int> todo{seed};
        region[static_cast<std::size_t>(seed)] = id;
        while (!todo.empty()) {
            const int at = todo.back();
            todo.pop_back();
            ++area.back();
            const int x = at % n, y = at / n;
            const int next[4][2] = {{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}};
            for (const auto& q : next) {
                if (q[0] < 0 || q[1] < 0 || q[0] >= n || q[1] >= n)
                    continue;
                int& r = region[static_cast<std::size_t>(q[1] * n + q[0])];
                if (r == 0) {
                    r = id;
                    todo.push_back(q[1] * n + q[0]);
                }
            }
        }
    }
    std::set<int> chambers;
    for (std::size_t i = 0; i < 4; ++i) {
        const HeartLumen lumen = heartLumens()[i];
        const glm::dvec3 q = lumen.inside - corner;
        const int x = static_cast<int>(std::lround(glm::dot(q, right) / step)),
                  y = static_cast<int>(std::lround(glm::dot(q, up) / step));
        ASSERT_TRUE(x > 0 && y > 0 && x < n && y < n) << lumen.name;
        const int id = region[static_cast<std::size_t>(y * n + x)];
        ASSERT_GT(id, 0) << lumen.name << " is cut off or filled";
        EXPECT_NE(id, region[0]) << lumen.name << " is open to the outside in the section";
        EXPECT_GT(area[static_cast<std::size_t>(id)] * step * step, 400) << lumen.name;
        chambers.insert(id);
    }
    EXPECT_EQ(chambers.size(), 4u);
}

TEST(Heart, IsAsLongAsStatedAndLiesAsAHeartLies) {
    EXPECT_NEAR(heartMuscleLength(), 120, 2);
    glm::dvec3 low(1e9), high(-1e9), apex(0);
    for (const auto& p : heart().positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
        if (p.y == low.y)
            apex = p;
    }
    EXPECT_GT(apex.x, 15) << "the apex points to the patient's left, the viewer's right";
    EXPECT_LT(glm::length(0.5 * (low + high)), 5);
    const auto lumens = heartLumens();
    EXPECT_GT(lumens[1].inside.z, lumens[0].inside.z) << "the right ventricle lies in front";
    EXPECT_LT(lumens[3].inside.x, lumens[2].inside.x) << "the right atrium lies on the viewer's left";
    EXPECT_GT(lumens[5].inside.z, lumens[4].inside.z) << "the pulmonary trunk crosses in front of the aorta";
    for (const HeartLumen& lumen : lumens)
        EXPECT_GT(heartDistance(lumen.inside), 3) << lumen.name;
}

TEST(Heart, ComesOutWithTheSameBytesAgain) {
    const sim::TriangleMesh again = makePhantom("heart", kFaces).value();
    ASSERT_EQ(again.positions.size(), heart().positions.size());
    ASSERT_EQ(again.faces.size(), heart().faces.size());
    EXPECT_EQ(std::memcmp(again.positions.data(), heart().positions.data(),
                          again.positions.size() * sizeof(again.positions[0])),
              0);
    EXPECT_EQ(
        std::memcmp(again.faces.data(), heart().faces.data(), again.faces.size() * sizeof(again.faces[0])),
        0);
    EXPECT_EQ(std::memcmp(again.colours.data(), heart().colours.data(),
                          again.colours.size() * sizeof(again.colours[0])),
              0);
}

} // namespace
} // namespace serosa::models
