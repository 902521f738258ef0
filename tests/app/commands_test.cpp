// Commands that need no GL context, as a user sees them.

#include "tests/app/child.h"

#include <gtest/gtest.h>

namespace serosa::app {
namespace {

TEST(Help, NamesEveryOptionItsUnitAndAnExample) {
    const TestFolder folder;
    for (const char* command : {"run", "inspect", "phantom", "verify", "doctor", "scene"}) {
        const ChildResult help = runSerosa(folder.path(), {command, "--help"});
        EXPECT_EQ(help.exitCode, 0) << command;
        EXPECT_EQ(help.err, "") << command;
        EXPECT_NE(help.out.find("serosa"), std::string::npos) << command;
    }
    const std::string run = runSerosa(folder.path(), {"run", "--help"}).out;
    for (const char* option :
         {"--model", "--length-unit", "--solver", "--gl", "--frames", "--size", "--mapping", "--out",
          "--force", "--nodes", "--spacing", "--layout", "Examples", "Exit codes"})
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

} // namespace
} // namespace serosa::app
