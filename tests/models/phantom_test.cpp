// The list of phantoms, and those with simple shapes.
#include "mesh_measures.h"
#include "models/phantom.h"
#include "models/simple_shapes.h"

#include <gtest/gtest.h>

#include <future>
#include <map>
#include <optional>
#include <set>

namespace serosa::models {
namespace {

TEST(Phantom, UnknownNameGetsASuggestion) {
    const auto made = makePhantom("haert", 1000);
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message.find("did you mean \"heart\""), std::string::npos);
    EXPECT_EQ(made.error().exitCode, exitBadInput);
    EXPECT_EQ(made.error().message.find('\n'), std::string::npos);
}

TEST(Phantom, ImpossibleFaceCountsAreRefused) {
    for (const PhantomInfo& info : phantoms()) {
        EXPECT_FALSE(makePhantom(info.name, 0).ok()) << info.name;
        EXPECT_FALSE(makePhantom(info.name, 2000000000).ok()) << info.name;
    }
    EXPECT_FALSE(makePhantom("heart", 500).ok());
    EXPECT_FALSE(makePhantom("ball", 100).ok()) << "20 n^2 is 80 or 180";
}

/// What a phantom is unless kForms says otherwise: one surface like a ball's, about the origin.
struct Form {
    std::size_t shells = 1;
    int genus = 0;           // of the outer shell
    double leastAngle = 20;  // of a face, degrees
    bool aboutOrigin = true; // else it lies where it belongs in another phantom
};
const std::map<std::string, Form> kForms = {
    {"coins", {1, 13, 8, false}}, // rings of touching coins are handles
    {"mask", {1, 2, 12, false}},  // two eyes
};

TEST(Phantom, AllAreSoundAtTheirDefaultCount) {
    for (const PhantomInfo& info : phantoms()) {
        if (info.name == "heart")
            continue; // heart_test.cpp
        SCOPED_TRACE(info.name);
        const sim::TriangleMesh& mesh = test::defaultPhantom(info.name);
        EXPECT_GE(mesh.faces.size(), info.defaultFaces);
        EXPECT_LE(static_cast<double>(mesh.faces.size()), 1.05 * static_cast<double>(info.defaultFaces));
        EXPECT_EQ(mesh.colours.size(), mesh.positions.size());
        EXPECT_EQ(test::manifoldFault(mesh), "");
        EXPECT_EQ(test::contacts(mesh), 0u);
        const auto entry = kForms.find(info.name);
        const Form form = entry == kForms.end() ? Form{} : entry->second;
        EXPECT_GT(test::leastAngle(mesh), form.leastAngle);
        const auto shells = test::shellsOf(mesh);
        ASSERT_EQ(shells.size(), form.shells);
        EXPECT_GT(shells[0].volume, 0);
        EXPECT_EQ(shells[0].genus, form.genus);
        const auto box = test::extentsOf(mesh);
        if (form.aboutOrigin) {
            EXPECT_LT(glm::length(box.lowest + box.highest), 0.25 * glm::length(box.size()));
        }
    }
}

TEST(Phantom, EachComesOutWithTheSameBytes) {
    const auto bytes = [](const auto& list) {
        const char* first = reinterpret_cast<const char*>(list.data());
        return std::string(first, list.size() * sizeof(list[0]));
    };
    // Those that take longest are compared with fewer faces.
    const auto facesOf = [](const PhantomInfo& info) {
        const bool fewer = std::set<std::string>{"golfball", "skin", "fish", "hand"}.contains(info.name);
        return fewer ? std::size_t{20000} : info.defaultFaces;
    };
    // The second ones come from two threads, which must not matter either.
    std::vector<std::optional<Result<sim::TriangleMesh>>> second(phantoms().size());
    const auto makeFrom = [&](std::size_t i) {
        for (; i < second.size(); i += 2)
            if (phantoms()[i].name != "heart") // heart_test.cpp
                second[i] = makePhantom(phantoms()[i].name, facesOf(phantoms()[i]));
    };
    auto other = std::async(std::launch::async, makeFrom, 1);
    makeFrom(0);
    other.get();
    for (std::size_t i = 0; i < second.size(); ++i) {
        if (!second[i])
            continue;
        const PhantomInfo& info = phantoms()[i];
        SCOPED_TRACE(info.name);
        const std::size_t faces = facesOf(info);
        const auto first =
            faces < info.defaultFaces ? makePhantom(info.name, faces) : test::defaultPhantom(info.name);
        const auto& again = *second[i];
        ASSERT_TRUE(first.ok() && again.ok());
        EXPECT_TRUE(bytes(first->positions) == bytes(again->positions));
        EXPECT_TRUE(bytes(first->faces) == bytes(again->faces));
        EXPECT_TRUE(bytes(first->colours) == bytes(again->colours));
    }
}

TEST(Phantom, DragonFillsTwoByTwoByOneCells) {
    const auto mesh = makePhantom("dragon", 10000);
    ASSERT_TRUE(mesh.ok());
    const glm::dvec3 extent = test::extentsOf(*mesh).size();
    const glm::dvec3 most(120, 120, 60);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(extent[axis], most[axis]);
        EXPECT_GE(extent[axis], 0.85 * most[axis]);
    }
    // Every cell of a 2 x 2 x 1 lattice about the origin holds some of it.
    bool held[2][2] = {};
    for (const auto& p : mesh->positions)
        held[p.x > 0][p.y > 0] = true;
    EXPECT_TRUE(held[0][0] && held[0][1] && held[1][0] && held[1][1]);
}

TEST(Phantom, BeamIsABox) {
    for (const std::size_t faces : {400u, 3600u, 20000u}) {
        const auto mesh = makePhantom("beam", faces);
        ASSERT_TRUE(mesh.ok()) << mesh.error().message;
        EXPECT_EQ(test::extentsOf(*mesh).size(), glm::dvec3(30, 30, 120));
        EXPECT_NEAR(test::volumeOf(*mesh), 30.0 * 30 * 120, 1e-6);
        EXPECT_EQ(test::manifoldFault(*mesh), "");
        EXPECT_GE(mesh->faces.size(), faces);
        EXPECT_LE(static_cast<double>(mesh->faces.size()), 1.05 * static_cast<double>(faces));
    }
}

TEST(Phantom, LayerIsABox) {
    const auto mesh = makePhantom("layer", 11520);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    EXPECT_EQ(mesh->faces.size(), 11520u);
    EXPECT_EQ(test::extentsOf(*mesh).size(), glm::dvec3(120, 48, 120));
    EXPECT_NEAR(test::volumeOf(*mesh), 120.0 * 48 * 120, 1e-6);
    EXPECT_EQ(test::manifoldFault(*mesh), "");
    EXPECT_FALSE(makePhantom("layer", 10000).ok());
}

TEST(Phantom, BallIsRound) {
    const auto mesh = makePhantom("ball", 5120);
    ASSERT_TRUE(mesh.ok());
    for (const auto& p : mesh->positions)
        EXPECT_NEAR(glm::length(p), kBallRadius, 1e-12);
    const double ball = 4.0 / 3.0 * glm::radians(180.0) * 64000;
    EXPECT_NEAR(test::volumeOf(*mesh), ball, 0.003 * ball);
}

} // namespace
} // namespace serosa::models
