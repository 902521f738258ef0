// The bodies of CSC06's and CS07's figures, measured on their meshes.
#include "mesh_measures.h"
#include "models/bank.h"
#include "models/coins.h"
#include "models/fish.h"
#include "models/hand.h"
#include "models/mask.h"
#include "models/phantom.h"
#include "models/torso.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>
#include <set>

namespace serosa::models {
namespace {

const double kPi = glm::radians(180.0);

TEST(FigureSolids, DistancesAreAlmostNowhereSteeperThanTheMesherAssumes) {
    for (const Solid* solid :
         {&bankSolid(), &coinsSolid(), &fishSolid(), &handSolid(), &torsoSolid(), &maskSolid()}) {
        const auto& distance = solid->source.distance;
        const Point lowest = solid->source.lowest, extent = solid->source.highest - lowest;
        std::size_t near = 0, steep = 0, verySteep = 0;
        for (int i = 0; i < 60000; ++i) { // an even sequence in the box
            const Point share =
                glm::fract(static_cast<double>(i) * Point(0.8191725134, 0.6710436067, 0.5497004779));
            const Point p = lowest + share * extent;
            const double d = distance(p);
            if (std::abs(d) > 2)
                continue;
            constexpr double e = 1e-3;
            const Point slope(distance(p + Point(e, 0, 0)) - d, distance(p + Point(0, e, 0)) - d,
                              distance(p + Point(0, 0, e)) - d);
            ++near;
            steep += glm::length(slope) / e > 1.15;
            verySteep += glm::length(slope) / e > 1.5;
        }
        // Flanks of scales, rims and creases are steeper; they are lower than a lattice cell.
        EXPECT_GT(near, 150u) << solid->name;
        EXPECT_LT(static_cast<double>(steep), 0.08 * static_cast<double>(near)) << solid->name;
        EXPECT_LT(static_cast<double>(verySteep), 0.015 * static_cast<double>(near)) << solid->name;
    }
}

/// Parts into which the surface `level(p) = 0` cuts the mesh: rings of faces that share cut edges.
std::size_t ringsCut(const sim::TriangleMesh& mesh, const std::function<double(const glm::dvec3&)>& level) {
    std::vector<bool> above;
    for (const auto& p : mesh.positions)
        above.push_back(level(p) > 0);
    std::map<std::pair<unsigned, unsigned>, std::size_t> firstWith;
    std::vector<std::size_t> parent(mesh.faces.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t f) {
        while (parent[f] != f)
            f = parent[f] = parent[parent[f]];
        return f;
    };
    std::vector<std::size_t> cut;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const unsigned a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 3];
            if (above[a] == above[b])
                continue;
            cut.push_back(f);
            const auto [entry, isNew] = firstWith.try_emplace({std::min(a, b), std::max(a, b)}, f);
            if (!isNew)
                parent[root(f)] = root(entry->second);
        }
    std::set<std::size_t> rings;
    for (const std::size_t f : cut)
        rings.insert(root(f));
    return rings.size();
}

TEST(Bank, WallIsAsThickAsStatedWhereNothingIsPutOnIt) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("bank");
    const auto normals = mesh.vertexNormals();
    std::size_t measured = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 11) {
        const glm::dvec3 p = mesh.positions[i], n = normals[i];
        const bool inner = glm::dot(n, p - glm::dvec3(8, 0, 0)) < 0 && std::hypot(p.y, p.z) < 51;
        const bool flank = p.x > -10 && p.x < 52 && p.y > 0 && p.y < 38 && std::abs(p.z) > 25;
        if (!inner || !flank)
            continue;
        const auto through = test::rayHit(mesh, p, -n, 0.5);
        ASSERT_TRUE(through);
        EXPECT_NEAR(*through, kBankWall, 0.1 * kBankWall) << p.x << " " << p.y << " " << p.z;
        ++measured;
    }
    EXPECT_GT(measured, 20u);
}

TEST(Bank, CavityHasTheVolumeOfTheBodyLessItsWalls) {
    // Cones from the middle to the faces of the cavity's wall; the slot takes one of 0.3% away.
    const sim::TriangleMesh& mesh = test::defaultPhantom("bank");
    const glm::dvec3 middle(8, -2, 0);
    double cavity = 0;
    for (const auto& f : mesh.faces) {
        const glm::dvec3 a = mesh.positions[f.x] - middle, b = mesh.positions[f.y] - middle,
                         c = mesh.positions[f.z] - middle;
        if (std::abs(bankCavityDistance(middle + (a + b + c) / 3.0)) < 0.4)
            cavity -= glm::dot(a, glm::cross(b, c)) / 6;
    }
    const auto ball = [](double a, double b, double c) { return 4.0 / 3.0 * kPi * a * b * c; };
    const double trunk = ball(62, 49, 49), head = ball(34, 35, 36);
    EXPECT_GT(cavity, trunk);
    EXPECT_LT(cavity, trunk + head);
    double counted = 0;
    constexpr double step = 2;
    for (double x = -98; x < 102; x += step)
        for (double y = -60; y < 60; y += step)
            for (double z = -60; z < 60; z += step)
                counted += bankCavityDistance({x, y, z}) < 0 ? step * step * step : 0;
    EXPECT_NEAR(cavity, counted, 0.02 * counted);
}

TEST(Bank, SlotOpensTheCavityAndTakesACoin) {
    // A coin on edge, well away from the walls of the slot, falls from above into the cavity.
    for (double y = 80; y > 30; y -= 0.5)
        for (const double x : {12 - kCoinRadius, 12.0, 12 + kCoinRadius})
            for (const double z : {-0.5 * kCoinThickness, 0.5 * kCoinThickness})
                EXPECT_GT(bankDistance({x, y, z}), 0.2) << x << " " << y << " " << z;
    EXPECT_LT(bankDistance({12, 49, 5}), 0);
    EXPECT_LT(bankDistance({40, 42.5, 0}), 0);
}

TEST(Coins, LieInTheCavityOfTheBank) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("coins");
    double deepest = -1e9;
    for (const auto& p : mesh.positions) {
        EXPECT_LT(bankCavityDistance(p), -0.2);
        EXPECT_GT(bankDistance(p), 0.2);
        deepest = std::max(deepest, bankCavityDistance(p));
    }
    EXPECT_GT(deepest, -2) << "they rest on its floor";
    EXPECT_LT(test::extentsOf(mesh).highest.y, 0) << "a heap, not a pillar";
}

TEST(Coins, AreAsManyAsTheirVolume) {
    EXPECT_EQ(coinHeap().size(), 26u);
    const double coin = kPi * kCoinRadius * kCoinRadius * kCoinThickness;
    EXPECT_NEAR(test::volumeOf(test::defaultPhantom("coins")) / coin, 26, 2.6);
    for (const Coin& one : coinHeap()) {
        EXPECT_LT(coinsDistance(one.at), -1);
        EXPECT_GT(one.axis.y, 0.2) << "none stands on its edge";
        for (const Coin& other : coinHeap())
            if (&one != &other) {
                EXPECT_GT(glm::length(one.at - other.at), 0.75 * kCoinThickness);
            }
    }
}

TEST(Fish, IsTheSameOnBothSides) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("fish");
    double moment = 0;
    for (const auto& f : mesh.faces) {
        const auto &a = mesh.positions[f.x], &b = mesh.positions[f.y], &c = mesh.positions[f.z];
        moment += glm::dot(a, glm::cross(b, c)) / 6 * (a.z + b.z + c.z) / 4;
    }
    EXPECT_LT(std::abs(moment / test::volumeOf(mesh)), 0.02); // z of the middle, mm
    for (std::size_t i = 0; i < mesh.positions.size(); i += 7) {
        const auto& p = mesh.positions[i];
        EXPECT_NEAR(fishDistance({p.x, p.y, -p.z}), 0, 1e-5);
    }
}

TEST(Fish, IsLongAndNarrowWithThinFins) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("fish");
    const glm::dvec3 size = test::extentsOf(mesh).size();
    EXPECT_NEAR(size.x, 186, 2);
    EXPECT_GT(size.x, 1.8 * size.y);
    EXPECT_GT(size.y, 1.2 * size.z);
    const glm::dvec2 onFins[] = {{-22, 40}, {18, 34}, {84, 26}, {84, -18}, {22, -27}};
    for (const glm::dvec2& at : onFins) {
        const glm::dvec3 from(at, 60), towards(0, 0, -1);
        const auto in = test::rayHit(mesh, from, towards, 0);
        ASSERT_TRUE(in) << at.x << " " << at.y;
        const auto out = test::rayHit(mesh, from, towards, *in + 1e-6);
        ASSERT_TRUE(out);
        EXPECT_NEAR(*out - *in, 3.2, 1.6) << at.x << " " << at.y;
    }
    EXPECT_EQ(ringsCut(mesh, [](const glm::dvec3& p) { return p.x - 89; }), 2u) << "the tail is forked";
}

TEST(Hand, HasFiveFingers) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("hand");
    const auto round = [](double radius) {
        return [radius](const glm::dvec3& p) { return glm::length(p - glm::dvec3(0, -45, 5)) - radius; };
    };
    EXPECT_EQ(ringsCut(mesh, round(84)), 5u) << "a ball about the palm cuts four fingers and the thumb";
    const auto height = [](double y) { return [y](const glm::dvec3& p) { return p.y - y; }; };
    EXPECT_EQ(ringsCut(mesh, height(40)), 4u);
    EXPECT_EQ(ringsCut(mesh, height(95)), 1u) << "the middle finger is the longest";
    EXPECT_EQ(ringsCut(mesh, height(-70)), 1u);
}

TEST(Hand, HasTheSizeOfAHandAndAFlatWrist) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("hand");
    const auto box = test::extentsOf(mesh);
    EXPECT_NEAR(box.highest.y - -87, 189, 3) << "from the wrist's crease to the longest tip";
    double flat = 0;
    for (const auto& f : mesh.faces) {
        const auto &a = mesh.positions[f.x], &b = mesh.positions[f.y], &c = mesh.positions[f.z];
        const glm::dvec3 n = 0.5 * glm::cross(b - a, c - a);
        if (std::max({a.y, b.y, c.y}) < box.lowest.y + 0.01)
            flat -= n.y;
    }
    const glm::dvec3 from(-100, -8, 0), across(1, 0, 0); // below the fingers, above the thumb's fold
    const auto in = test::rayHit(mesh, from, across, 0);
    ASSERT_TRUE(in);
    EXPECT_NEAR(*test::rayHit(mesh, from, across, *in + 1e-6) - *in, 82, 6) << "breadth of the palm";
    EXPECT_GT(flat, 0.5 * kPi * 28 * 19) << "the cut, an ellipse of the wrist's half sizes less its edge";
    EXPECT_GT(box.highest.x, 70) << "the thumb of a right hand whose palm faces the viewer";
}

TEST(Torso, HasTheProportionsAndTheReliefOfAMansTrunk) {
    const sim::TriangleMesh& mesh = test::defaultPhantom("torso");
    const glm::dvec3 size = test::extentsOf(mesh).size();
    EXPECT_NEAR(size.y, 592, 2);
    EXPECT_NEAR(size.x, 525, 20);
    EXPECT_NEAR(size.z, 255, 15);
    const auto skin = [&](double x, double y) {
        return 300 - *test::rayHit(mesh, {x, y, 300}, {0, 0, -1}, 0);
    };
    EXPECT_LT(skin(0, -162), skin(32, -162) - 3) << "navel";
    EXPECT_LT(skin(0, 90), skin(60, 90) - 3) << "between the breasts";
    EXPECT_GT(skin(104, 64), 100);
    EXPECT_GT(skin(70, 207), skin(70, 228) + 4) << "collar bone";
    const double waist = 2 * (300 - *test::rayHit(mesh, {300, -100, 0}, {-1, 0, 0}, 0));
    EXPECT_NEAR(waist, 276, 15);
    for (std::size_t i = 0; i < mesh.positions.size(); i += 7) {
        const auto& p = mesh.positions[i];
        EXPECT_NEAR(torsoDistance({-p.x, p.y, p.z}), 0, 1e-5);
    }
}

TEST(Mask, LiesUnderTheSkinOfTheTorsosChest) {
    const sim::TriangleMesh &mask = test::defaultPhantom("mask"), &torso = test::defaultPhantom("torso");
    double nearest = 1e9;
    for (const auto& p : mask.positions) {
        ASSERT_LE(torsoDistance(p), -3);
        for (const auto& q : torso.positions)
            nearest = std::min(nearest, glm::length(p - q));
    }
    EXPECT_NEAR(nearest, 10, 2.5);
    // It faces the chest: from outside, a ray meets the torso's skin, then the mask.
    for (const glm::dvec2 at : {glm::dvec2(0, 110), glm::dvec2(20, 40), glm::dvec2(-20, 40)}) {
        const auto skin = test::rayHit(torso, {at, 300}, {0, 0, -1}, 0);
        const auto face = test::rayHit(mask, {at, 300}, {0, 0, -1}, 0);
        ASSERT_TRUE(skin && face);
        EXPECT_GT(*face, *skin + 3);
        EXPECT_LT(*face, *skin + 50);
        const auto behind = test::rayHit(mask, {at, 300}, {0, 0, -1}, *face + 1e-6);
        ASSERT_TRUE(behind);
        EXPECT_LT(*behind - *face, 4 * kMaskWall) << "thin and hollow behind";
    }
}

TEST(Mask, HasTwoEyes) {
    const sim::TriangleMesh& mask = test::defaultPhantom("mask");
    std::size_t open = 0;
    for (const double x : {-25.0, 25.0})
        open += !test::rayHit(mask, {x, 78, 300}, {0, 0, -1}, 0);
    EXPECT_EQ(open, 2u);
    EXPECT_TRUE(test::rayHit(mask, {0, 78, 300}, {0, 0, -1}, 0)) << "the nose is between them";
}

} // namespace
} // namespace serosa::models
