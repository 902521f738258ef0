// Cuts of a scene: what is read, what is refused, and what sweeps in which frame.
#include "sim/cut_motion.h"
#include "tests/sim/scene_files.h"

#include <gtest/gtest.h>

using namespace serosa;
using sim::Cut;
using sim::Stroke;

namespace {

Cut threeKeys() {
    Cut cut;
    cut.keys = {{0.1, {0, 0, 0}, {0, 0, 1}}, {0.2, {1, 0, 0}, {1, 0, 1}}, {0.5, {1, 3, 0}, {1, 3, 1}}};
    return cut;
}

} // namespace

TEST(CutMotion, partsOfASweepJoinWithoutGaps) {
    const Cut cut = threeKeys();
    std::vector<Stroke> all;
    for (int frame = 0; frame < 36; ++frame) // 1/60 s: keys fall inside frames
        for (const Stroke& stroke : cut.strokes(frame / 60.0, (frame + 1) / 60.0))
            all.push_back(stroke);
    ASSERT_GT(all.size(), 20u);
    EXPECT_EQ(all.front().from[0], glm::dvec3(0, 0, 0));
    EXPECT_EQ(all.back().to[1], glm::dvec3(1, 3, 1));
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].continues, i > 0);
        if (i > 0) {
            EXPECT_EQ(all[i].from, all[i - 1].to) << i;
        }
        EXPECT_TRUE(all[i].from[0].y == 0 || all[i].from[0].x == 1) << "a part cuts the corner at a key";
    }
    EXPECT_TRUE(cut.strokes(0.5, 1).empty());
    EXPECT_TRUE(cut.strokes(0, 0.1).empty());
}

TEST(CutMotion, ballsBurnOnceAtTheirKeys) {
    Cut cut = threeKeys();
    cut.kind = sim::StrokeKind::cauterize;
    cut.keys.front().time = 0;
    EXPECT_EQ(cut.strokes(0, 0.2).size(), 2u); // the key at 0 and the one at the end
    EXPECT_EQ(cut.strokes(0.2, 0.4).size(), 0u);
    EXPECT_EQ(cut.strokes(0.4, 0.5).size(), 1u);
    EXPECT_EQ(cut.strokes(0, 0.2)[1].from[0], glm::dvec3(1, 0, 0));
}

namespace serosa::sim {
namespace {

class CutScene : public ::testing::Test {
protected:
    std::string refusal(const std::string& lines) {
        const Result<Scene> scene = readScene(files_.write(SceneFiles::minimal() + lines));
        return scene ? "" : scene.error().message;
    }
    SceneFiles files_;
};

TEST_F(CutScene, isReadInSiUnits) {
    const auto scene = readScene(files_.write(
        SceneFiles::minimal() +
        "tear_strain = 0.8\n"
        "[[cut]]\nkeys = [{ t = \"0 s\", at = [\"1 mm\", \"2 mm\", \"3 mm\"], end = [\"4 mm\", \"5 mm\", \"6 "
        "mm\"] },\n"
        "{ t = \"20 ms\", at = [\"0 mm\", \"0 mm\", \"0 mm\"], end = [\"1 mm\", \"0 mm\", \"0 mm\"] }]\n"
        "[[cut]]\nkind = \"cauterize\"\nkeys = [{ t = \"1 s\", at = [\"0 mm\", \"7 mm\", \"0 mm\"] }]\n"));
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(scene->organs[0].tearStrain, 0.8);
    ASSERT_EQ(scene->cuts.size(), 2u);
    EXPECT_EQ(scene->cuts[0].kind, StrokeKind::blade);
    EXPECT_EQ(scene->cuts[0].keys[0].end, glm::dvec3(0.004, 0.005, 0.006));
    EXPECT_EQ(scene->cuts[0].keys[1].time, 0.02);
    EXPECT_EQ(scene->cuts[1].kind, StrokeKind::cauterize);
    EXPECT_EQ(scene->cuts[1].radius, 0.003); // the default that the reference states
    EXPECT_EQ(scene->cuts[1].keys[0].at, glm::dvec3(0, 0.007, 0));
}

TEST_F(CutScene, badOnesAreRefusedByLine) {
    const std::string zero = "at = [\"0 m\", \"0 m\", \"0 m\"]", end = ", end = [\"1 m\", \"0 m\", \"0 m\"]";
    const auto key = [&](const std::string& t, const std::string& rest) {
        return "{ t = \"" + t + "\", " + zero + rest + " }";
    };
    const auto says = [&](const std::string& lines, const std::string& part) {
        const std::string message = refusal(lines);
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_NE(message.find("toml:"), std::string::npos) << message;
    };
    says("[[cut]]\nkeys = [" + key("0 s", end) + "]\n", "at least two");
    says("[[cut]]\nkeys = [" + key("0 s", end) + ", " + key("0 s", end) + "]\n", "times must increase");
    says("[[cut]]\nkeys = [" + key("1 s", end) + ", " + key("0 s", end) + "]\n", "times must increase");
    says("[[cut]]\nkeys = [" + key("0 s", end) + ", " + key("1 s", "") + "]\n", "two ends");
    says("[[cut]]\nradius = \"1 mm\"\nkeys = [" + key("0 s", end) + ", " + key("1 s", end) + "]\n",
         "no effect on a blade");
    says("[[cut]]\nkind = \"cauterize\"\nkeys = [" + key("0 s", end) + "]\n", "no effect on cauterizing");
    says("[[cut]]\nkind = \"laser\"\nkeys = [" + key("0 s", end) + "]\n", "known: blade, cauterize");
    says("[[cut]]\nkind = \"cauterize\"\nkeys = []\n", "at least one");
    says("tear_strain = 0\n", "greater than 0");
    says("tear_strain = 1\n[organ.pose]\nbend_radius = \"1 m\"\n", "beside 'pose'");
    says("[organ.pose]\nbend_radius = \"1 m\"\n[[cut]]\nkeys = [" + key("0 s", end) + ", " + key("1 s", end) +
             "]\n",
         "every organ has a pose");
}

} // namespace
} // namespace serosa::sim
