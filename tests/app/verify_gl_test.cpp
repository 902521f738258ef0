// `serosa verify` as a user runs it: it passes as built, each fault fails the group that owns it, and the
// report has the form that docs/cli.md gives.

#include "tests/app/child.h"
#include "tests/app/page_reader.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace serosa::app {
namespace {

std::string glChoice() {
    const char* gl = std::getenv("SEROSA_TEST_GL");
    return gl ? gl : "auto";
}

/// The solver group takes half a minute: one backend will do, and without sanitizers.
bool isLongRun() {
#if defined(__SANITIZE_ADDRESS__)
    return false;
#else
    return glChoice() != "osmesa";
#endif
}

nlohmann::json reportIn(const TestFolder& folder) {
    return nlohmann::json::parse(readWhole(folder.path() / "v" / "verify.json"), nullptr, false);
}

TEST(GlVerify, MappingPassesAndReportsInTheStatedForm) {
    const TestFolder folder;
    const ChildResult result =
        runSerosa(folder.path(), {"verify", "mapping", "--gl", glChoice(), "--out", "v"});
    EXPECT_EQ(result.exitCode, 0) << result.out << result.err;
    EXPECT_EQ(result.err, "");
    const nlohmann::json report = reportIn(folder);
    ASSERT_TRUE(report.is_object());
    ASSERT_EQ(report.size(), 1u);
    ASSERT_TRUE(report.contains("mapping"));
    ASSERT_FALSE(report["mapping"].empty());
    for (const nlohmann::json& check : report["mapping"]) {
        EXPECT_EQ(check.size(), 7u) << check;
        EXPECT_TRUE(check.at("name").is_string());
        const std::string kind = check.at("kind");
        EXPECT_TRUE(kind == "equal_abs" || kind == "equal_rel" || kind == "at_most" || kind == "at_least")
            << kind;
        for (const char* figure : {"measured", "expected", "tolerance"})
            EXPECT_TRUE(check.at(figure).is_number()) << check;
        EXPECT_TRUE(check.at("unit").is_string());
        EXPECT_EQ(check.at("pass"), true) << check;
    }
}

TEST(GlVerify, StaleNormalFailsTheMappingGroup) {
    const TestFolder folder;
    const ChildResult result = runSerosa(
        folder.path(), {"verify", "mapping", "--gl", glChoice(), "--inject", "stale-normal", "--out", "v"});
    EXPECT_EQ(result.exitCode, 1) << result.out << result.err;
    int failed = 0;
    const nlohmann::json report = reportIn(folder);
    for (const nlohmann::json& check : report["mapping"])
        failed += check["pass"] == false;
    EXPECT_GT(failed, 0);
    const std::string text = readWhole(folder.path() / "v" / "report.html");
    const PageReader page(text);
    EXPECT_EQ(page.error(), "");
    EXPECT_EQ(page.all("tr", "failed", page.byId("failures")).size(), std::size_t(failed));
    EXPECT_EQ(page.all("tr", "check", page.byId("group-1")).size(), report["mapping"].size());
    EXPECT_NE(page.all("div", "verdict").at(0)->text.find("--inject stale-normal"), std::string::npos);
}

TEST(GlVerify, StaleNormalsFailTheSurfaceGroup) {
    if (!isLongRun())
        GTEST_SKIP() << "runs on EGL, without sanitizers";
    const TestFolder folder;
    EXPECT_EQ(runSerosa(folder.path(), {"verify", "surface", "--gl", glChoice(), "--inject", "stale-normal"})
                  .exitCode,
              1);
}

int exitCodeWith(const char* group, const char* fault) {
    const TestFolder folder;
    return runSerosa(folder.path(),
                     {"verify", group, "--solver", "compute", "--gl", glChoice(), "--inject", fault})
        .exitCode;
}

TEST(GlVerify, AMissingSpringFailsTheSolverGroup) {
    if (!isLongRun())
        GTEST_SKIP() << "runs on EGL, without sanitizers";
    EXPECT_EQ(exitCodeWith("solver", "drop-spring"), 1);
}

TEST(GlVerifyLong, SpringFaultsFailTheGroupsThatOwnThem) {
    if (!isLongRun())
        GTEST_SKIP() << "runs on EGL, without sanitizers";
    EXPECT_EQ(exitCodeWith("solver", "stiffness=1.05"), 1);
    EXPECT_EQ(exitCodeWith("materials", "stiffness=1.05"), 1);
    EXPECT_EQ(exitCodeWith("fem", "stiffness=1.1"), 1);
}

} // namespace
} // namespace serosa::app
