// Files beside a scene: another surface for an organ, a volume for its cuts, and which organs a deformation
// is of.
#include "tests/app/child.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace serosa::app {
namespace {

const char* const kOrgan = "[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 100\nname = ";
const char* const kTail = "[look]\nshow = \"implicit\"\nfield_samples = 24\n[output]\nsize = [48, 48]\n";

class GlSceneFiles : public ::testing::Test {
protected:
    void SetUp() override {
        const ChildResult made =
            runSerosa(folder_.path(), {"phantom", "ball", "--faces", "500", "-o", "ball.ply"});
        ASSERT_EQ(made.exitCode, 0) << made.err;
        // Two balls, 80 mm wide, beside each other.
        folder_.write("two.toml", head() + kTail);
    }
    static std::string head() {
        return "schema = 1\nduration = \"20 ms\"\ngravity = [\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]\n" +
               std::string(kOrgan) + "\"left\"\n" + kOrgan +
               "\"right\"\nat = [\"100 mm\", \"0 mm\", \"0 mm\"]\n";
    }
    ChildResult run(const std::string& scene, std::vector<std::string> more = {}) const {
        const char* gl = std::getenv("SEROSA_TEST_GL");
        std::vector<std::string> arguments{"run", scene, "--gl", gl ? gl : "auto", "--out", "out", "--force"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runSerosa(folder_.path(), arguments);
    }
    TestFolder folder_;
};

TEST_F(GlSceneFiles, AnotherSurfaceComesToTheSizeAndPlaceOfTheOrgansOwn) {
    // A tetrahedron, z up: its box is 3 x 2 x 4 in its own axes, 4 high in the world.
    folder_.write("other.off",
                  "OFF\n4 4 0\n7 0 0\n10 0 0\n7 2 0\n7 0 4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    folder_.write("surfaces.toml", head() + kTail + "surfaces_at = [\"0 s\"]\n");
    const ChildResult done = run("surfaces.toml", {"--surface", "right=other.off", "--up-axis", "z"});
    ASSERT_EQ(done.exitCode, 0) << done.err;
    const auto summary = nlohmann::json::parse(readWhole(folder_.path() / "out" / "summary.json"));
    EXPECT_EQ(summary["organs"][0]["model"], "ball.ply");
    EXPECT_EQ(summary["organs"][1]["model"], "other.off");
    const double scale = summary["organs"][1]["metres_per_unit"],
                 volume = summary["organs"][1]["lattice"]["volume_m3"];
    EXPECT_NEAR(scale, 0.08 / 4, 2e-4); // the ball's corners lie on its surface
    EXPECT_NEAR(volume, 4 * scale * scale * scale, 1e-6 * volume);

    const ChildResult own =
        run("surfaces.toml", {"--surface", "right=other.off", "--up-axis", "z", "--length-unit", "cm"});
    ASSERT_EQ(own.exitCode, 0) << own.err;
    const auto kept = nlohmann::json::parse(readWhole(folder_.path() / "out" / "summary.json"));
    EXPECT_DOUBLE_EQ(kept["organs"][1]["metres_per_unit"], 0.01);
}

TEST_F(GlSceneFiles, BadSurfacesAreRefusedInOneLine) {
    folder_.write("open.off", "OFF\n4 3 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n");
    const std::pair<std::vector<std::string>, const char*> cases[] = {
        {{"--surface", "lft=ball.ply"}, "did you mean 'left'"},
        {{"--surface", "ball.ply"}, "write ORGAN=FILE"},
        {{"--surface", "left="}, "names no file"},
        {{"--surface", "left=gone.ply"}, "gone.ply"},
        {{"--surface", "left=open.off"}, "open.off"},
        {{"--surface", "left=ball.ply", "--surface", "left=ball.ply"}, "twice"},
        {{"--up-axis", "z"}, "--surface"}};
    for (const auto& [arguments, says] : cases) {
        const ChildResult refused = run("two.toml", arguments);
        EXPECT_EQ(refused.exitCode, 2) << says;
        EXPECT_EQ(refused.errorLines(), 1u) << refused.err;
        EXPECT_NE(refused.err.find(says), std::string::npos) << refused.err;
    }
}

TEST_F(GlSceneFiles, ADeformationIsOfTheOrgansThatItNames) {
    const auto scene = [](const std::string& organs) {
        return head() + kTail + "[deformation]\nkind = \"sphere\"\nat = [\"100 mm\", \"0 mm\", \"0 mm\"]\n" +
               "size = [\"60 mm\", \"60 mm\", \"60 mm\"]\nradius = \"25 mm\"\n" + organs;
    };
    folder_.write("right.toml", scene("organs = [\"right\"]\n"));
    folder_.write("left.toml", scene("organs = [\"left\"]\n"));
    EXPECT_EQ(run("right.toml").exitCode, 0);
    const ChildResult left = run("left.toml");
    EXPECT_EQ(left.exitCode, 2);
    EXPECT_NE(left.err.find("outside of every organ that it is of"), std::string::npos) << left.err;
}

// Between its keys it is looked at, too.
TEST_F(GlSceneFiles, ADeformationMayPassThroughAnOrgan) {
    const auto scene = [](const std::string& height) {
        return head() + kTail +
               "[[deformation]]\nkind = \"pull\"\nat = [\"0 mm\", \"0 mm\", \"0 mm\"]\n"
               "size = [\"60 mm\", \"" +
               height +
               "\", \"60 mm\"]\namount = \"5 mm\"\nradius = \"8 mm\"\nkeys = [\n"
               "{ t = \"0 s\", at = [\"-200 mm\", \"10 mm\", \"0 mm\"] },\n"
               "{ t = \"1 s\", at = [\"200 mm\", \"10 mm\", \"0 mm\"] } ]\n";
    };
    folder_.write("passes.toml", scene("120 mm")); // its top lies above the balls
    const ChildResult passes = run("passes.toml");
    EXPECT_EQ(passes.exitCode, 0) << passes.err;
    folder_.write("tears.toml", scene("40 mm")); // in them
    const ChildResult tears = run("tears.toml");
    EXPECT_EQ(tears.exitCode, 2);
    EXPECT_NE(tears.err.find("torn"), std::string::npos) << tears.err;
}

// A table that a scene's own `show` gives sense to is not passed over where the command line says another.
TEST_F(GlSceneFiles, ShowIsHeldAgainstTheScene) {
    folder_.write("cut.toml", head() + kTail +
                                  "[deformation]\nkind = \"sphere\"\nat = [\"0 mm\", \"0 mm\", \"0 mm\"]\n"
                                  "size = [\"60 mm\", \"60 mm\", \"60 mm\"]\nradius = \"25 mm\"\n");
    for (const char* const show : {"surface", "both"}) {
        const ChildResult refused = run("cut.toml", {"--show", show});
        EXPECT_EQ(refused.exitCode, 2) << show;
        EXPECT_NE(refused.err.find("look.show: deformations move what is ray-cast"), std::string::npos)
            << refused.err;
    }
}

TEST_F(GlSceneFiles, TheVertexStageMovesWhatItCan) {
    const auto scene = [](const std::string& bend, const std::string& top = "") {
        return top + head() + kTail +
               "[[deformation]]\nkind = \"sphere\"\nat = [\"0 mm\", \"30 mm\", \"0 mm\"]\n" +
               "size = [\"60 mm\", \"60 mm\", \"60 mm\"]\nradius = \"15 mm\"\norgans = [\"left\"]\n" +
               "[[deformation]]\nkind = \"bend\"\nby = \"vertices\"\norgans = [\"left\"]\n" + bend;
    };
    const std::string box = "at = [\"0 mm\", \"0 mm\", \"0 mm\"]\nsize = [\"90 mm\", \"90 mm\", \"90 mm\"]\n";
    folder_.write("bent.toml", scene(box + "angle = \"50 deg\"\nextent = \"80 mm\"\n"));
    const ChildResult bent = run("bent.toml");
    EXPECT_EQ(bent.exitCode, 0) << bent.err;
    std::string falls = scene(box + "angle = \"50 deg\"\nextent = \"80 mm\"\n");
    falls.replace(falls.find("\"0 m/s2\""), 8, "\"9 m/s2\"");
    folder_.write("falls.toml", falls);
    folder_.write("folds.toml", scene(box + "angle = \"170 deg\"\nextent = \"60 mm\"\n"));
    folder_.write("away.toml",
                  scene("at = [\"0 mm\", \"500 mm\", \"0 mm\"]\nsize = [\"90 mm\", \"90 mm\", \"90 mm\"]\n"
                        "angle = \"50 deg\"\nextent = \"80 mm\"\n"));
    const std::pair<const char*, const char*> cases[] = {{"falls.toml", "this one can move"},
                                                         {"folds.toml", "inside out"},
                                                         {"away.toml", "outside of every organ"}};
    for (const auto& [file, says] : cases) {
        const ChildResult refused = run(file);
        EXPECT_EQ(refused.exitCode, 2) << file;
        EXPECT_EQ(refused.errorLines(), 1u) << refused.err;
        EXPECT_NE(refused.err.find(says), std::string::npos) << refused.err;
        EXPECT_NE(refused.err.find(std::string(file) + ":2"), std::string::npos) << refused.err;
    }
}

TEST_F(GlSceneFiles, AVolumeMustMeetAnOrgan) {
    const auto scene = [](const std::string& lines) {
        return head() + kTail + "[look.cut_volume]\nfile = \"ct.nrrd\"\n" + lines;
    };
    const std::string header = "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 2 2\n"
                               "space: left-posterior-superior\n"
                               "space directions: (20,0,0) (0,20,0) (0,0,20)\nspace origin: (150,0,0)\n"
                               "encoding: ascii\n\n";
    folder_.write("ct.nrrd", header + "1 2 3 4 5 6 7 8\n"); // from 140 to 180 mm; the right ball ends at 140
    folder_.write("met.toml", scene("at = [\"-60 mm\", \"0 mm\", \"0 mm\"]\n"));
    folder_.write("unmet.toml", scene("at = [\"5 mm\", \"0 mm\", \"0 mm\"]\n"));
    const ChildResult met = run("met.toml"), unmet = run("unmet.toml");
    EXPECT_EQ(met.exitCode, 0) << met.err;
    EXPECT_EQ(unmet.exitCode, 2);
    EXPECT_EQ(unmet.errorLines(), 1u) << unmet.err;
    EXPECT_NE(unmet.err.find("unmet.toml:21: look.cut_volume"), std::string::npos) << unmet.err;
}

TEST_F(GlSceneFiles, AVolumeOfColoursHasNoWindowAndNoLabels) {
    const auto scene = [](const std::string& lines) {
        return head() + kTail +
               "[look.cut_volume]\nfile = \"rgb.nrrd\"\nat = [\"-60 mm\", \"0 mm\", \"0 mm\"]\n" + lines;
    };
    folder_.write("rgb.nrrd", "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 3 2 1 1\n"
                              "kinds: RGB-color domain domain domain\nspace: left-posterior-superior\n"
                              "space directions: none (20,0,0) (0,20,0) (0,0,20)\nspace origin: (150,0,0)\n"
                              "encoding: ascii\n\n200 30 20 10 20 255\n");
    folder_.write("alone.toml", scene(""));
    folder_.write("window.toml", scene("level = 40\n"));
    folder_.write("label.toml", scene("[[look.cut_volume.label]]\nvalue = 1\ncolour = [1, 2, 3]\n"));
    const ChildResult alone = run("alone.toml");
    EXPECT_EQ(alone.exitCode, 0) << alone.err;
    for (const char* name : {"window.toml", "label.toml"}) {
        const ChildResult refused = run(name);
        EXPECT_EQ(refused.exitCode, 2) << name;
        EXPECT_EQ(refused.errorLines(), 1u) << refused.err;
        EXPECT_NE(refused.err.find("rgb.nrrd: has colours"), std::string::npos) << refused.err;
    }
}

} // namespace
} // namespace serosa::app
