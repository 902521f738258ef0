// Commands that need no GL context, as a user sees them.

#include "tests/app/child.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
namespace serosa::app {
namespace {

TEST(Help, NamesEveryOptionItsUnitAndAnExample) {
    const TestFolder folder;
    for (const char* command :
         {"run", "inspect", "repair", "phantom", "verify", "bench", "doctor", "scene"}) {
        const ChildResult help = runSerosa(folder.path(), {command, "--help"});
        EXPECT_EQ(help.exitCode, 0) << command;
        EXPECT_EQ(help.err, "") << command;
        EXPECT_NE(help.out.find("serosa"), std::string::npos) << command;
    }
    const std::string run = runSerosa(folder.path(), {"run", "--help"}).out;
    for (const char* option :
         {"--model", "--length-unit", "--solver", "--gl", "--frames", "--size", "--mapping", "--out",
          "--force", "--nodes", "--spacing", "--layout", "--repair", "--up-axis", "Examples", "Exit codes"})
        EXPECT_NE(run.find(option), std::string::npos) << option;
    EXPECT_EQ(runSerosa(folder.path(), {"--version"}).out.rfind("serosa 0.", 0), 0u);
}

TEST(Inspect, SaysWhatTheMeshIs) {
    const TestFolder folder;
    ASSERT_EQ(runSerosa(folder.path(), {"phantom", "ball", "--faces", "500", "-o", "ball.ply"}).exitCode, 0);
    const ChildResult result =
        runSerosa(folder.path(), {"inspect", "ball.ply", "--length-unit", "mm", "--nodes", "300"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.out.find("(1 solid, 0 cavities)"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("lattice"), std::string::npos) << result.out;
}

TEST(Repair, MendsSaysWhatAndLeavesGoodFilesAsTheyAre) {
    const TestFolder folder;
    ASSERT_EQ(runSerosa(folder.path(), {"phantom", "ball", "--faces", "500", "-o", "ball.ply"}).exitCode, 0);
    const ChildResult good = runSerosa(folder.path(), {"repair", "ball.ply", "-o", "good.ply"});
    EXPECT_EQ(good.exitCode, 0) << good.err;
    EXPECT_EQ(good.out.rfind("repair: nothing to mend\n", 0), 0u) << good.out;
    EXPECT_EQ(readWhole(folder.path() / "ball.ply"), readWhole(folder.path() / "good.ply"));

    const std::string inward = "OFF\n5 4 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n9 9 9\n"
                               "3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n";
    folder.write("inward.off", inward);
    const ChildResult refused = runSerosa(folder.path(), {"inspect", "inward.off"});
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_NE(refused.err.find("inverted"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("--repair"), std::string::npos) << refused.err;
    const ChildResult inspected = runSerosa(folder.path(), {"inspect", "inward.off", "--repair"});
    EXPECT_EQ(inspected.exitCode, 0) << inspected.err;
    EXPECT_NE(inspected.out.find("repair: flipped 4 faces"), std::string::npos) << inspected.out;
    EXPECT_NE(inspected.out.find("repair: removed 1 stray vertex"), std::string::npos) << inspected.out;
    const ChildResult mended = runSerosa(folder.path(), {"repair", "inward.off", "-o", "outward.off"});
    EXPECT_EQ(mended.exitCode, 0) << mended.err;
    EXPECT_EQ(readWhole(folder.path() / "outward.off"),
              "OFF\n4 4 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    EXPECT_EQ(runSerosa(folder.path(), {"repair", "inward.off", "-o", "outward.off"}).exitCode, 2);
    EXPECT_EQ(runSerosa(folder.path(), {"repair", "inward.off", "-o", "outward.off", "--force"}).exitCode, 0);
}

TEST(Repair, RefusesWhatItDoesNotMend) {
    const TestFolder folder;
    folder.write("open.off", "OFF\n4 2 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n");
    const auto before = folder.names();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"repair", "open.off", "-o", "new.off"},
          std::vector<std::string>{"repair", "gone.off", "-o", "new.off"},
          std::vector<std::string>{"repair", "open.off", "-o", "."},
          std::vector<std::string>{"inspect", "open.off", "--repair"},
          std::vector<std::string>{"run", "--model", "open.off", "--length-unit", "mm", "--repair"},
          std::vector<std::string>{"run", "--model", "open.off", "--length-unit", "mm", "--up-axis", "w"},
          std::vector<std::string>{"run", "open.toml", "--repair"},
          std::vector<std::string>{"run", "open.toml", "--up-axis", "z"}}) {
        const ChildResult result = runSerosa(folder.path(), arguments);
        EXPECT_EQ(result.exitCode, 2) << result.out;
        EXPECT_EQ(result.errorLines(), 1u) << result.err;
        EXPECT_EQ(folder.names(), before);
    }
    const ChildResult plain = runSerosa(folder.path(), {"inspect", "open.off"});
    EXPECT_EQ(plain.err.find("--repair"), std::string::npos) << "a hint that does not help: " << plain.err;
}

TEST(SceneCommands, CheckAndExplain) {
    const TestFolder folder;
    ASSERT_EQ(runSerosa(folder.path(), {"phantom", "ball", "--faces", "500", "-o", "ball.ply"}).exitCode, 0);
    folder.write("ball.toml",
                 "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 300\n"
                 "[organ.tissue]\nyoung = \"3 kPa\"\n");
    const ChildResult check = runSerosa(folder.path(), {"scene", "check", "ball.toml"});
    EXPECT_EQ(check.exitCode, 0) << check.err;
    EXPECT_NE(check.out.find("ok"), std::string::npos);
    const ChildResult explain = runSerosa(folder.path(), {"scene", "explain", "ball.toml"});
    EXPECT_EQ(explain.exitCode, 0) << explain.err;
    EXPECT_NE(explain.out.find("line 7    3000 Pa"), std::string::npos) << explain.out;
    EXPECT_NE(explain.out.find("default   1000 kg/m3"), std::string::npos) << explain.out;
    EXPECT_NE(explain.out.find("steps a frame"), std::string::npos) << explain.out;
}

const std::string kDeformed =
    "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 300\n"
    "[look]\nshow = \"implicit\"\n[deformation]\nat = [\"0 mm\", \"0 mm\", \"0 mm\"]\nformat = \"single\"\n";

/// D of a texel of a scene's deformation, mm: written by the program, side texels along each axis.
std::array<float, 3> texelOf(const TestFolder& folder, const std::string& scene, int side, int x, int y,
                             int z) {
    folder.write("some.toml", kDeformed + scene);
    const ChildResult made =
        runSerosa(folder.path(), {"scene", "deformation", "some.toml", "-o", "some.nrrd", "--force"});
    EXPECT_EQ(made.exitCode, 0) << made.err;
    const std::string all = readWhole(folder.path() / "some.nrrd");
    const std::size_t head = all.find("\n\n") + 2;
    EXPECT_EQ(all.size() - head, std::size_t(side * side * side * 4) * sizeof(float));
    std::array<float, 3> texel{};
    const std::size_t at = head + std::size_t(x + side * (y + side * z)) * 4 * sizeof(float);
    if (at + sizeof texel <= all.size())
        std::memcpy(texel.data(), all.data() + at, sizeof texel);
    return texel;
}

// A place that was dragged comes back to where it rests; what is far from all of them stays.
TEST(SceneCommands, PointsOfASceneAreDragged) {
    const TestFolder folder;
    ASSERT_EQ(runSerosa(folder.path(), {"phantom", "ball", "--faces", "500", "-o", "ball.ply"}).exitCode, 0);
    const std::string scene =
        "kind = \"points\"\nsize = [\"100 mm\", \"100 mm\", \"100 mm\"]\n"
        "texels = [20, 20, 20]\nreach = \"25 mm\"\npoints = [{ from = [\"2.5 mm\", \"-1.5 mm\", "
        "\"2.5 mm\"], to = [\"12.5 mm\", \"2.5 mm\", \"2.5 mm\"] }]\n";
    const auto there = texelOf(folder, scene, 20, 12, 10, 10), far = texelOf(folder, scene, 20, 3, 10, 10);
    EXPECT_NEAR(there[0], -10, 1e-4);
    EXPECT_NEAR(there[1], -4, 1e-4);
    EXPECT_NEAR(there[2], 0, 1e-4);
    EXPECT_EQ(far, (std::array<float, 3>{0, 0, 0}));
}

// Forward x' = x + y / 10: backward D = -y' / 10, which a file of another program's forward displacement
// comes to.
TEST(SceneCommands, AForwardImageOfASceneIsInverted) {
    const TestFolder folder;
    ASSERT_EQ(runSerosa(folder.path(), {"phantom", "ball", "--faces", "500", "-o", "ball.ply"}).exitCode, 0);
    std::string nrrd =
        "NRRD0004\ntype: float\ndimension: 4\nspace: left-posterior-superior\nsizes: 3 10 10 10\n"
        "space directions: none (10,0,0) (0,10,0) (0,0,10)\nkinds: vector domain domain domain\n"
        "space origin: (-45,-45,-45)\nencoding: ascii\n\n";
    for (int z = 0; z < 10; ++z)
        for (int y = 0; y < 10; ++y)
            for (int x = 0; x < 10; ++x)
                nrrd += std::to_string(0.1 * (10 * y - 45)) + " 0 0\n";
    folder.write("forward.nrrd", nrrd);
    for (const int y : {2, 4, 7}) {
        const auto texel = texelOf(folder, "kind = \"image\"\nfile = \"forward.nrrd\"\n", 10, 5, y, 4);
        EXPECT_NEAR(texel[0], -0.1 * (10 * y - 45), 1e-4) << y;
        EXPECT_NEAR(texel[1], 0, 1e-4);
        EXPECT_NEAR(texel[2], 0, 1e-4);
    }
}

// A texture that was written is the deformation that it was made from.
TEST(SceneCommands, DeformationsGoThroughFiles) {
    const TestFolder folder;
    ASSERT_EQ(runSerosa(folder.path(), {"phantom", "ball", "--faces", "500", "-o", "ball.ply"}).exitCode, 0);
    const std::string scene =
        "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 300\n"
        "[look]\nshow = \"implicit\"\n[deformation]\nat = [\"0 mm\", \"0 mm\", \"0 mm\"]\n";
    folder.write("twist.toml", scene + "kind = \"twist\"\nsize = [\"200 mm\", \"200 mm\", \"200 mm\"]\n"
                                       "angle = \"30 deg\"\ntexels = [16, 16, 16]\nformat = \"single\"\n");
    const ChildResult made = runSerosa(folder.path(), {"scene", "deformation", "twist.toml", "-o", "a.nrrd"});
    EXPECT_EQ(made.exitCode, 0) << made.err;
    folder.write("file.toml", scene + "kind = \"texture\"\nfile = \"a.nrrd\"\nformat = \"single\"\n");
    const ChildResult again = runSerosa(folder.path(), {"scene", "deformation", "file.toml", "-o", "b.nrrd"});
    EXPECT_EQ(again.exitCode, 0) << again.err;
    const std::string a = readWhole(folder.path() / "a.nrrd"), b = readWhole(folder.path() / "b.nrrd");
    ASSERT_EQ(a.size(), b.size());
    const std::size_t head = a.find("\n\n") + 2;
    ASSERT_EQ(a.substr(0, head), b.substr(0, head));
    ASSERT_EQ(a.size() - head, std::size_t(16 * 16 * 16 * 4) * sizeof(float));
    float most = 0, off = 0;
    for (std::size_t i = head; i < a.size(); i += sizeof(float)) {
        float x = 0, y = 0;
        std::memcpy(&x, a.data() + i, sizeof x);
        std::memcpy(&y, b.data() + i, sizeof y);
        most = std::max(most, std::abs(x));
        off = std::max(off, std::abs(x - y));
    }
    EXPECT_GT(most, 10); // mm
    EXPECT_LT(off, 1e-5) << "metres in memory, millimetres in the file";
    const ChildResult exists =
                          runSerosa(folder.path(), {"scene", "deformation", "file.toml", "-o", "b.nrrd"}),
                      none = runSerosa(folder.path(), {"scene", "deformation", "file.toml", "--number", "2",
                                                       "-o", "c.nrrd"});
    EXPECT_EQ(exists.exitCode, 2);
    EXPECT_EQ(none.exitCode, 2);
    EXPECT_EQ(none.errorLines(), 1U) << none.err;
}

TEST(SceneCommands, SayWhichMethodSteps) {
    const TestFolder folder;
    ASSERT_EQ(runSerosa(folder.path(), {"phantom", "ball", "--faces", "500", "-o", "ball.ply"}).exitCode, 0);
    const std::string stiff =
        "schema = 1\n[[organ]]\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 300\n"
        "method = \"implicit\"\n[organ.tissue]\nyoung = \"100 GPa\"\n";
    folder.write("stiff.toml", stiff);
    const ChildResult check = runSerosa(folder.path(), {"scene", "check", "stiff.toml"});
    EXPECT_EQ(check.exitCode, 0) << check.err;
    EXPECT_NE(check.out.find("1 steps a frame (1 implicit)"), std::string::npos) << check.out;
    const ChildResult explain = runSerosa(folder.path(), {"scene", "explain", "stiff.toml"});
    EXPECT_EQ(explain.exitCode, 0) << explain.err;
    for (const char* text : {"line 6    \"implicit\"", "0.01667 s, implicit, one a frame", "; not taken"})
        EXPECT_NE(explain.out.find(text), std::string::npos) << text << explain.out;

    // What explicit steps would need, in one line.
    std::string tooStiff = stiff;
    tooStiff.erase(tooStiff.find("method"), tooStiff.find("[organ.tissue]") - tooStiff.find("method"));
    for (const auto& [text, says] : {std::pair{tooStiff, std::string("set method = \"implicit\"")}}) {
        folder.write("bad.toml", text);
        for (const std::vector<std::string>& arguments :
             {std::vector<std::string>{"scene", "check", "bad.toml"}, {"run", "bad.toml"}}) {
            const ChildResult bad = runSerosa(folder.path(), arguments);
            EXPECT_EQ(bad.exitCode, 2) << text;
            EXPECT_EQ(bad.errorLines(), 1U) << bad.err;
            EXPECT_NE(bad.err.find(says), std::string::npos) << says << bad.err;
        }
    }
}

} // namespace
} // namespace serosa::app
