// `serosa bench --pick` and `--solver picked`: measured, written, used only where it is asked for.

#include "app/solver_choice.h"
#include "app/user_config.h"
#include "tests/app/child.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace serosa::app {
namespace {

/// XDG_CONFIG_HOME in a folder of the test's own, which does not exist yet.
class ConfigFolder {
public:
    ConfigFolder() : path_(folder_.path() / "a" / "b") { setenv("XDG_CONFIG_HOME", path_.c_str(), 1); }
    ~ConfigFolder() { unsetenv("XDG_CONFIG_HOME"); }
    std::filesystem::path file() const { return path_ / "serosa" / "config.toml"; }
    void write(const std::string& text) const {
        std::filesystem::create_directories(file().parent_path());
        std::ofstream(file()) << text;
    }

private:
    TestFolder folder_;
    std::filesystem::path path_;
};

TEST(UserConfig, LiesWhereTheStandardSays) {
    const ConfigFolder config;
    EXPECT_EQ(userConfigFile().value(), config.file());
    setenv("XDG_CONFIG_HOME", "relative", 1); // the standard: ignored
    const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
    setenv("HOME", "/home/someone", 1);
    EXPECT_EQ(userConfigFile().value(), "/home/someone/.config/serosa/config.toml");
    unsetenv("HOME");
    EXPECT_FALSE(userConfigFile().ok());
    setenv("HOME", home.c_str(), 1);
}

TEST(UserConfig, WritesTheChoiceAndKeepsAllElse) {
    const ConfigFolder config;
    EXPECT_NE(readPickedSolver().error().message.find("serosa bench --pick"), std::string::npos);
    ASSERT_TRUE(writePickedSolver({"compute", 123, "some \"renderer\""}).ok()) << "makes the folders";
    const PickedSolver picked = readPickedSolver().value();
    EXPECT_EQ(picked.solver, "compute");
    EXPECT_EQ(picked.nodes, 123u);
    EXPECT_EQ(picked.renderer, "some \"renderer\"");
    config.write("[other]\nkey = 7\n[picked]\nsolver = \"fragment\"\n");
    ASSERT_TRUE(writePickedSolver({"reference", 5, ""}).ok());
    EXPECT_EQ(readPickedSolver().value().solver, "reference");
    EXPECT_NE(readWhole(config.file()).find("key = 7"), std::string::npos);
}

TEST(UserConfig, BadContentIsAnErrorWithItsPlace) {
    const ConfigFolder config;
    config.write("[picked]\nsolver = \"computer\"\n");
    const std::string unknown = readPickedSolver().error().message;
    EXPECT_NE(unknown.find("config.toml:1:"), std::string::npos) << unknown;
    EXPECT_NE(unknown.find("compute"), std::string::npos) << unknown;
    config.write("[picked\n");
    EXPECT_NE(readPickedSolver().error().message.find("config.toml:1:"), std::string::npos);
    EXPECT_FALSE(writePickedSolver({"fragment", 5, ""}).ok())
        << "a file that is not understood is not replaced";
    EXPECT_EQ(readWhole(config.file()), "[picked\n");
}

TEST(GlPick, MeasuresWritesAndIsUsedOnlyWhenAsked) {
    const TestFolder folder;
    const std::string home = (folder.path() / "config").string();
    const ChildOptions options{{{"XDG_CONFIG_HOME", home}}, -1, ""};
    const std::vector<std::string> run{"run",    "--model",  "beam.ply", "--length-unit", "mm",    "--nodes",
                                       "300",    "--frames", "1",        "--size",        "64x64", "--solver",
                                       "picked", "--out",    "out"};
    ASSERT_EQ(runSerosa(folder.path(), {"phantom", "beam", "-o", "beam.ply"}, options).exitCode, 0);
    const ChildResult unpicked = runSerosa(folder.path(), run, options);
    EXPECT_EQ(unpicked.exitCode, 2);
    EXPECT_EQ(unpicked.errorLines(), 1u) << unpicked.err;
    EXPECT_NE(unpicked.err.find("serosa bench --pick"), std::string::npos) << unpicked.err;

    const ChildResult bench = runSerosa(
        folder.path(), {"bench", "--pick", "--nodes", "500", "--rounds", "1", "--seconds", "0.01"}, options);
    ASSERT_EQ(bench.exitCode, 0) << bench.err;
    for (const std::string& name : solverNames())
        EXPECT_NE(bench.out.find("\n" + name + " "), std::string::npos) << bench.out;
    setenv("XDG_CONFIG_HOME", home.c_str(), 1);
    const PickedSolver picked = readPickedSolver().value();
    EXPECT_GT(picked.nodes, 300u);

    // Which one was fastest is the machine's affair: the run must take what the file says.
    ASSERT_TRUE(writePickedSolver({"compute", 500, ""}).ok());
    unsetenv("XDG_CONFIG_HOME");
    const ChildResult used = runSerosa(folder.path(), run, options);
    ASSERT_EQ(used.exitCode, 0) << used.err;
    const auto solverOf = [&folder](const char* out) {
        return nlohmann::json::parse(readWhole(folder.path() / out / "summary.json"))["solver"]
            .get<std::string>();
    };
    EXPECT_EQ(solverOf("out"), "compute");
    std::vector<std::string> plain(run.begin(), run.end() - 4);
    plain.insert(plain.end(), {"--out", "plain"});
    ASSERT_EQ(runSerosa(folder.path(), plain, options).exitCode, 0);
    EXPECT_EQ(solverOf("plain"), "fragment") << "nothing switches by itself";
}

} // namespace
} // namespace serosa::app
