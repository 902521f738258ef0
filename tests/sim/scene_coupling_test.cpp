// Organs that touch and threads of a scene file: what is read, and what is refused.

#include "tests/sim/scene_files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace serosa::sim {
namespace {

const std::string kModel = "model = \"ball.ply\"\nlength_unit = \"mm\"\n";
const std::string kTwo = "[[organ]]\nname = \"liver\"\n" + kModel + "[[organ]]\nname = \"kidney\"\n" + kModel;

/// \param top before the organs (line 2 on)
std::string twoOrgans(const std::string& more, const std::string& top = "") {
    return "schema = 1\n" + top + kTwo + more; // `more` begins on line 10 where top is empty
}
std::string place(double x) {
    return "[\"" + std::to_string(x) + " mm\", \"0 mm\", \"0 mm\"]";
}
std::string ends(const std::string& first, double x, const std::string& second, double y) {
    return "ends = [{ organ = \"" + first + "\", at = " + place(x) + " }, { organ = \"" + second +
           "\", at = " + place(y) + " }]\n";
}

class SceneCoupling : public ::testing::Test {
protected:
    Scene mustRead(const std::string& text) {
        const Result<Scene> scene = files_.read(text);
        EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
        return scene.ok() ? *scene : Scene{};
    }
    /// \param position "line:" and perhaps the column
    void expectRefused(const std::string& text, const std::string& position, const std::string& says) {
        const Result<Scene> scene = files_.read(text);
        ASSERT_FALSE(scene.ok()) << text;
        const std::string& message = scene.error().message;
        EXPECT_NE(message.find("scene.toml:" + position), std::string::npos) << message;
        EXPECT_NE(message.find(says), std::string::npos) << message;
    }
    SceneFiles files_;
};

TEST_F(SceneCoupling, ThreadsAreRead) {
    const Scene scene =
        mustRead(twoOrgans("[[thread]]\n" + ends("liver", 10, "kidney", 14) +
                           "[[thread]]\nname = \"clip\"\nkind = \"clip\"\nt = \"500 ms\"\nlength = \"2 mm\"\n"
                           "tightening = \"1 s\"\nstrength = \"300 mN\"\n" +
                           ends("kidney", 3, "kidney", 9)));
    ASSERT_EQ(scene.threads.size(), 2u);
    const Thread &first = scene.threads[0], &clip = scene.threads[1];
    EXPECT_EQ(first.name, "thread 1");
    EXPECT_FALSE(first.clip);
    EXPECT_NEAR(first.length, 0.004, 1e-12) << "as far as its ends lie apart";
    EXPECT_TRUE(std::isinf(first.strength));
    EXPECT_EQ(first.ends[0].organ, "liver");
    EXPECT_EQ(first.ends[1].organ, "kidney");
    EXPECT_EQ(first.ends[1].line, 11);
    EXPECT_NEAR(first.ends[1].at.x, 0.014, 1e-12);
    EXPECT_TRUE(clip.clip);
    EXPECT_EQ(clip.name, "clip");
    EXPECT_DOUBLE_EQ(clip.time, 0.5);
    EXPECT_DOUBLE_EQ(clip.length, 0.002);
    EXPECT_DOUBLE_EQ(clip.tightening, 1);
    EXPECT_DOUBLE_EQ(clip.strength, 0.3);
}

TEST_F(SceneCoupling, SaysWhoIsCoupled) {
    const Scene apart = mustRead(twoOrgans(""));
    EXPECT_FALSE(couplingOf(apart, 0).any() || couplingOf(apart, 1).any());
    const Scene touch =
        mustRead(twoOrgans("self_contact = true\n", "organs_touch = true\norgan_friction = 0.3\n"));
    EXPECT_TRUE(couplingOf(touch, 0).touches);
    EXPECT_FALSE(couplingOf(touch, 0).touchesItself);
    EXPECT_TRUE(couplingOf(touch, 1).touches && couplingOf(touch, 1).touchesItself);
    EXPECT_EQ(couplingOf(touch, 1).line, 2);
    EXPECT_DOUBLE_EQ(touch.organFriction, 0.3);
    const Scene tied = mustRead(twoOrgans("[[thread]]\n" + ends("kidney", 1, "kidney", 2)));
    EXPECT_FALSE(couplingOf(tied, 0).any()) << "the liver is tied to nothing";
    EXPECT_TRUE(couplingOf(tied, 1).tied);
    EXPECT_FALSE(couplingOf(tied, 1).touches);
    EXPECT_EQ(couplingOf(tied, 1).line, 11);
    const Scene one =
        mustRead(SceneFiles::minimal() + "self_contact = true\n[[thread]]\nends = [{ at = " + place(0) +
                 " }, { at = " + place(1) + " }]\n");
    EXPECT_TRUE(couplingOf(one, 0).touchesItself && couplingOf(one, 0).tied);
    EXPECT_EQ(one.threads.at(0).ends[0].organ, "organ") << "the only one";
}

TEST_F(SceneCoupling, OrgansArePlaced) {
    EXPECT_EQ(mustRead(twoOrgans("at = " + place(80) + "\n")).organs[1].at, glm::dvec3(0.08, 0, 0));
}

TEST_F(SceneCoupling, EndsThatAreNoEndsAreRefused) {
    expectRefused(twoOrgans("[[thread]]\n" + ends("liver", 0, "kidny", 1)), "11:", "did you mean 'kidney'");
    expectRefused(twoOrgans("[[thread]]\n" + ends("liver", 0, "spleen", 1)), "11:", "known: liver, kidney");
    expectRefused(twoOrgans("[[thread]]\nends = [{ at = " + place(0) + " }, { at = " + place(1) + " }]\n"),
                  "11:", "'organ' is missing");
    expectRefused(twoOrgans("[[thread]]\nends = [{ organ = \"liver\" }]\n"), "11:", "two ends");
    expectRefused(twoOrgans("[[thread]]\nends = [{ organ = \"liver\" }, { organ = \"liver\" }]\n"),
                  "11:", "at' is missing");
    expectRefused(twoOrgans("[[thread]]\nname = \"x\"\n"), "10:", "ends' is missing");
    expectRefused(twoOrgans("[[thread]]\n" + ends("liver", 5, "liver", 5) + "length = \"1 mm\"\n"),
                  "11:", "to itself");
    expectRefused(twoOrgans("[[thread]]\nkind = \"clip\"\n" + ends("liver", 5, "liver", 5)),
                  "12:", "to itself");
    expectRefused(twoOrgans("[[thread]]\n" + ends("liver", 5, "kidney", 5)), "10:", "'length' is missing");
    mustRead(twoOrgans("[[thread]]\nlength = \"1 mm\"\n" + ends("liver", 5, "kidney", 5)));
    expectRefused("schema = 1\n[[organ]]\nname = \"liver\"\n" + kModel +
                      "[organ.pose]\nbend_radius = \"1 m\"\n" + "[[organ]]\nname = \"kidney\"\n" + kModel +
                      "[[thread]]\n" + ends("liver", 0, "kidney", 1),
                  "13:", "has a pose");
}

TEST_F(SceneCoupling, ValuesOutOfRangeAndUnknownKeysAreRefused) {
    const std::string tied = ends("liver", 0, "kidney", 1);
    expectRefused(twoOrgans("[[thread]]\nlength = \"0 mm\"\n" + tied), "11:10", "greater than 0");
    expectRefused(twoOrgans("[[thread]]\nlength = \"-1 mm\"\n" + tied), "11:10", "greater than 0");
    expectRefused(twoOrgans("[[thread]]\nstrength = \"0 N\"\n" + tied), "11:12", "greater than 0");
    expectRefused(twoOrgans("[[thread]]\nstrength = \"-2 N\"\n" + tied), "11:12", "greater than 0");
    expectRefused(twoOrgans("[[thread]]\nstrength = 2\n" + tied), "11:12", "has no unit");
    expectRefused(twoOrgans("[[thread]]\nstrenght = \"2 N\"\n" + tied), "11:1", "did you mean 'strength'");
    expectRefused(twoOrgans("[[thread]]\nkind = \"suture\"\n" + tied), "11:8", "clip");
    expectRefused(twoOrgans("[[threads]]\n" + tied), "10:", "did you mean 'thread'");
    expectRefused(twoOrgans("", "organs_touch = true\norgan_friction = -0.1\n"), "3:18", "at least 0");
    expectRefused(twoOrgans("", "organs_touch = 1\n"), "2:16", "true or false");
    expectRefused(twoOrgans("[[thread]]\nname = \"a\"\n" + tied + "[[thread]]\nname = \"a\"\n" + tied),
                  "14:", "another thread");
    std::string many;
    for (int i = 0; i < 65; ++i)
        many += "[[thread]]\n" + tied;
    expectRefused(twoOrgans(many), "10:", "65 threads, at most 64");
}

TEST_F(SceneCoupling, WhatHasNoEffectOrIsNotSupportedIsRefused) {
    expectRefused("schema = 1\norgans_touch = true\n[[organ]]\n" + kModel, "2:", "self_contact = true");
    expectRefused(twoOrgans("", "organ_friction = 0.2\n"), "2:", "no organ touches");
    expectRefused(SceneFiles::minimal() + "self_contact = true\n[organ.pose]\nbend_radius = \"1 m\"\n",
                  "5:", "beside 'pose'");
    expectRefused(twoOrgans("levels = 2\n", "organs_touch = true\n"), "11:", "coupling of line 2");
    expectRefused(twoOrgans("levels = 2\n[[thread]]\n" + ends("liver", 0, "kidney", 1)),
                  "10:", "coupling of line 12");
    expectRefused(SceneFiles::minimal() + "self_contact = true\nlevels = 2\n", "6:", "coupling of line 5");
}

} // namespace
} // namespace serosa::sim
