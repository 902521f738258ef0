// Levels of detail in a run: the script is followed, the drawn surface does not jump, tools that hold and
// cuts keep an organ on its level, and a run goes on from a snapshot with the same bytes, in a fade too.
#include "app/level_rule.h"
#include "app/scene_player.h"
#include "app/scene_snapshot.h"
#include "models/phantom.h"
#include "sim/mesh_writer.h"
#include "tests/app/child.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace serosa::app {
namespace {

const char kOrgan[] = "schema = 1\nduration = \"1 s\"\n[[organ]]\nname = \"ball\"\nmodel = \"ball.ply\"\n"
                      "length_unit = \"mm\"\nnodes = 900\n";
const char kHeld[] = "[[organ.fixed]]\nshape = \"lowest\"\nshare = 0.3\n[organ.tissue]\nyoung = \"2 kPa\"\n";
const char kScript[] = "levels = 3\nlevel = [{ t = \"100 ms\", level = 2 }, { t = \"200 ms\", level = 3 }, "
                       "{ t = \"300 ms\", level = 1 }]\n";
const char kSmall[] = "[output]\nsize = [64, 48]\n";

class GlLevels : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const auto ball = models::makePhantom("ball", 500);
        ASSERT_TRUE(ball);
        ASSERT_TRUE(sim::writeMesh(*ball, folder_.path() / "ball.ply"));
    }
    std::unique_ptr<RunParts> parts(const std::string& scene) {
        folder_.write("scene.toml", scene);
        RunOptions options;
        options.scene = folder_.path() / "scene.toml";
        options.solver = GetParam();
        if (const char* gl = std::getenv("SEROSA_TEST_GL"))
            options.gl = gpu::parseGlChoice(gl).value();
        auto made = std::make_unique<RunParts>();
        const Status prepared = prepareRun(options, *made);
        EXPECT_TRUE(prepared.ok()) << (prepared.ok() ? "" : prepared.error().message);
        return made;
    }
    static void play(ScenePlayer& player, int frames) {
        while (player.frame() < frames)
            player.advance();
    }
    static std::vector<glm::dvec3> drawn(RunParts& parts) {
        return parts.renderer->readDeformedPositions(parts.organs[0]->textures(), parts.surfaceMapping());
    }
    static double farthest(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
        double most = 0;
        for (std::size_t i = 0; i < a.size(); ++i)
            most = std::max(most, glm::distance(a[i], b[i]));
        return most;
    }
    static std::vector<std::pair<int, int>> changes(const ScenePlayer& player) {
        std::vector<std::pair<int, int>> all;
        for (const LevelChange& change : player.levelChanges(0))
            all.emplace_back(change.frame, change.level);
        return all;
    }
    using Changes = std::vector<std::pair<int, int>>;

    TestFolder folder_;
};

TEST_P(GlLevels, FollowTheScriptAndTheDrawnSurfaceDoesNotJump) {
    // One after the other: each run has a context of its own.
    std::vector<std::vector<glm::dvec3>> onItsOwn;
    {
        const auto without = parts(std::string(kOrgan) + kHeld + kSmall);
        ScenePlayer plain(*without);
        for (int frame = 1; frame <= 40; ++frame) {
            plain.advance();
            onItsOwn.push_back(drawn(*without));
        }
    }
    const auto with = parts(std::string(kOrgan) + kScript + kHeld + kSmall);
    const double h = with->organs[0]->lattice.spacing;
    const std::size_t nodes = with->organs[0]->lattice.nodeCount();
    ScenePlayer player(*with);
    std::vector<glm::dvec3> last = drawn(*with);
    double jump = 0, swing = 0;
    for (int frame = 1; frame <= 40; ++frame) {
        player.advance();
        const std::vector<glm::dvec3> now = drawn(*with), &expected = onItsOwn[std::size_t(frame - 1)];
        const double moved = farthest(now, last);
        (frame == 6 || frame == 12 || frame == 18 ? jump : swing) =
            std::max(frame == 6 || frame == 12 || frame == 18 ? jump : swing, moved);
        // The switch itself, to rounding, moved nothing that is drawn.
        if (frame == 6) {
            EXPECT_LT(farthest(now, expected), 1e-4 * h);
        }
        last = now;
    }
    EXPECT_EQ(changes(player), (Changes{{0, 1}, {6, 2}, {12, 3}, {18, 1}}));
    EXPECT_EQ(with->organs[0]->lattice.nodeCount(), nodes) << "back on the organ's own";
    EXPECT_GT(swing, 0.1 * h) << "it moves";
    EXPECT_LT(jump, swing + 0.1 * h) << "frames with a switch are like others";
    // Once more from rest: the same.
    const std::string hash = player.stateHash();
    player.reset();
    EXPECT_EQ(changes(player), (Changes{{0, 1}}));
    play(player, 40);
    EXPECT_EQ(player.stateHash(), hash);
}

TEST_P(GlLevels, GoOnFromASnapshotWithTheSameBytes) {
    const std::string scene = std::string(kOrgan) + kScript + kHeld + kSmall;
    struct Played {
        std::string bytes, then, later; // snapshot; hashes there and at frame 25
        std::vector<glm::dvec3> drawn;
    };
    std::vector<Played> played;
    sim::Snapshot wrong;
    {
        const auto whole = parts(scene);
        for (const int at : {5, 9, 12, 15, 20}) { // before, in fades, at a switch, with detail kept
            ScenePlayer player(*whole);
            play(player, at);
            const sim::Snapshot snapshot = player.snapshot();
            if (at == 9)
                wrong = snapshot;
            Played one{sim::snapshotBytes(snapshot), player.stateHash(), "", {}};
            play(player, 25);
            one.later = player.stateHash();
            one.drawn = drawn(*whole);
            played.push_back(one);
        }
    }
    const auto rest = parts(scene);
    for (const Played& one : played) {
        const auto again = sim::parseSnapshot(one.bytes, "it");
        ASSERT_TRUE(again);
        ScenePlayer later(*rest);
        RunOptions options;
        const Status fits = checkStart(*again, options, *rest);
        ASSERT_TRUE(fits.ok()) << fits.error().message;
        later.restore(*again);
        EXPECT_EQ(later.stateHash(), one.then);
        play(later, 25);
        EXPECT_EQ(later.stateHash(), one.later) << again->frame;
        EXPECT_EQ(farthest(drawn(*rest), one.drawn), 0) << again->frame;
    }
    // Bytes that belong to no organ of these levels.
    wrong.organs[0].levelState.pop_back();
    EXPECT_FALSE(checkStart(wrong, {}, *rest).ok());
    wrong.organs[0].level = 4;
    EXPECT_FALSE(checkStart(wrong, {}, *rest).ok());
}

TEST_P(GlLevels, WaitForToolsThatHold) {
    const auto made = parts(std::string(kOrgan) + kScript + kHeld +
                            "[[tool]]\nradius = \"30 mm\"\nmode = \"grasp\"\nkeys = [{ t = \"80 ms\", at = "
                            "[\"40 mm\", \"0 mm\", \"0 mm\"] }, { t = \"220 ms\", at = [\"60 mm\", \"0 mm\", "
                            "\"0 mm\"] }]\n" +
                            kSmall);
    ScenePlayer player(*made);
    play(player, 25);
    EXPECT_EQ(changes(player), (Changes{{0, 1}, {14, 3}, {18, 1}}));
}

TEST_P(GlLevels, ACutOrganStays) {
    const auto made =
        parts(std::string(kOrgan) + kScript + kHeld +
              "[[cut]]\nkind = \"cauterize\"\nradius = \"15 mm\"\nkeys = [{ t = \"150 ms\", at = [\"0 "
              "mm\", \"40 mm\", \"0 mm\"] }]\n" +
              kSmall);
    ScenePlayer player(*made);
    play(player, 25);
    EXPECT_EQ(changes(player), (Changes{{0, 1}, {6, 2}}));
    EXPECT_GT(player.cuts(0).strokes(), 0u);
    player.reset(); // whole again
    EXPECT_EQ(changes(player), (Changes{{0, 1}}));
}

TEST_P(GlLevels, FollowTheRule) {
    const auto made =
        parts("schema = 1\nduration = \"2 s\"\ngravity = [\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]\n" +
              std::string(kOrgan).substr(std::string(kOrgan).find("[[organ]]")) +
              "levels = 3\nlevel_of_detail = \"auto\"\n" + kHeld +
              "[[tool]]\nradius = \"30 mm\"\nkeys = [{ t = \"0.7 s\", at = [\"0 mm\", \"900 "
              "mm\", \"0 mm\"] }, { t = \"1 s\", at = [\"0 mm\", \"60 mm\", \"0 mm\"] }]\n" +
              kSmall);
    ScenePlayer player(*made);
    play(player, 30);
    // At rest and alone: the coarsest, after two looks; a tool comes: the finest, before it is there.
    EXPECT_EQ(changes(player), (Changes{{0, 1}, {21, 3}}));
    play(player, 60);
    ASSERT_EQ(changes(player).size(), 3u);
    EXPECT_EQ(changes(player).back().second, 1);
    EXPECT_LT(changes(player).back().first, 55);
}

// A coarse lattice rests elsewhere: each switch sets the organ in motion, which asks for the finer one again.
// The rule must wait longer and longer, and not keep it in motion.
TEST_P(GlLevels, LetAnOrganComeToRest) {
    if (GetParam() != std::string("cpu"))
        return; // the rule is the same for all
    const auto made =
        parts("schema = 1\nduration = \"6 s\"\n[[body]]\nkind = \"floor\"\nheight = \"-50 mm\"\n" +
              std::string(kOrgan).substr(std::string(kOrgan).find("[[organ]]")) +
              "levels = 3\nlevel_of_detail = \"auto\"\n[organ.tissue]\nyoung = \"3 kPa\"\n" + kSmall);
    ScenePlayer player(*made);
    play(player, 360);
    const Changes all = changes(player);
    ASSERT_GT(all.size(), 2u) << "it does switch";
    EXPECT_LT(all.size(), 10u);
    const auto late =
        std::count_if(all.begin(), all.end(), [](const auto& change) { return change.first > 240; });
    EXPECT_LE(late, 1);
}

TEST_P(GlLevels, RefuseWhatHoldsNothingOnACoarseLattice) {
    folder_.write("scene.toml", std::string(kOrgan) + kScript +
                                    "[[organ.fixed]]\nshape = \"sphere\"\ncentre = [\"3 mm\", \"48 mm\", \"5 "
                                    "mm\"]\nradius = \"9 mm\"\n" +
                                    kSmall);
    RunOptions options;
    options.scene = folder_.path() / "scene.toml";
    options.solver = GetParam();
    if (const char* gl = std::getenv("SEROSA_TEST_GL"))
        options.gl = gpu::parseGlChoice(gl).value();
    RunParts made;
    const Status prepared = prepareRun(options, made);
    ASSERT_FALSE(prepared.ok());
    EXPECT_NE(prepared.error().message.find("on the lattice of level "), std::string::npos)
        << prepared.error().message;
}

INSTANTIATE_TEST_SUITE_P(Solvers, GlLevels, ::testing::Values("fragment", "compute", "cpu", "reference"));

TEST(LevelRule, ScriptsHoldFromTheirTimeOn) {
    sim::Organ organ;
    organ.levelKeys = {{0.1, 2}, {0.5, 1}};
    EXPECT_EQ(scriptedLevel(organ, 0), 1);
    EXPECT_EQ(scriptedLevel(organ, 6 / 60.0), 2);
    EXPECT_EQ(scriptedLevel(organ, 0.49), 2);
    EXPECT_EQ(scriptedLevel(organ, 0.5), 1);
}

} // namespace
} // namespace serosa::app
