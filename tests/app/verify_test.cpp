// The framework of verification: what passes, what fails, and how it is written.

#include "app/verify/report.h"
#include "app/verify/verify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace serosa::app {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Check, PassesByItsKind) {
    CheckList list;
    list.equalAbs("in", 1.05, 1, 0.0501, "m");
    list.equalAbs("out", 1.06, 1, 0.0501, "m");
    list.equalRel("in", -2.02, -2, 0.011, "1"); // 0.022 allowed
    list.equalRel("out", -2.03, -2, 0.011, "1");
    list.atMost("in", 3, 3, "h");
    list.atMost("out", 3.0001, 3, "h");
    list.atLeast("in", 3, 3, "h");
    list.atLeast("out", 2.9999, 3, "h");
    for (const Check& check : list.checks())
        EXPECT_EQ(check.pass(), check.name == "in") << checkKindName(check.kind) << " " << check.measured;
}

TEST(Check, NanAndInfinityNeverPass) {
    CheckList list;
    list.equalAbs("", kNan, 1, 1e9, "");
    list.equalAbs("", 1, kNan, 1e9, "");
    list.equalRel("", kNan, kNan, 1, "");
    list.atMost("", kNan, 1, "");
    list.atMost("", -std::numeric_limits<double>::infinity(), 1, "");
    list.atLeast("", std::numeric_limits<double>::infinity(), 1, "");
    for (const Check& check : list.checks())
        EXPECT_FALSE(check.pass()) << checkKindName(check.kind);
}

TEST(Check, SkippedIsAFailureUnlessAllowed) {
    CheckList list;
    list.skip("period", "needs a GPU");
    EXPECT_FALSE(list.checks()[0].pass());
    EXPECT_FALSE(accepted(list.checks()[0], false));
    EXPECT_TRUE(accepted(list.checks()[0], true));
}

TEST(VerifyJson, HasTheKeysOfTheReference) {
    CheckList list;
    list.equalRel("E", 1.01, 1, 0.02, "1");
    list.atMost("gap", kNan, 0.6, "h");
    list.skip("period", "needs a GPU");
    const nlohmann::ordered_json json = verifyJson({{"solver", list.checks()}}, false);
    ASSERT_EQ(json["solver"].size(), 3u);
    EXPECT_EQ(
        json["solver"][0].dump(),
        R"({"name":"E","kind":"equal_rel","measured":1.01,"expected":1.0,"tolerance":0.02,"unit":"1","pass":true})");
    EXPECT_EQ(json["solver"][1]["pass"], false);
    EXPECT_NE(json["solver"][1].dump().find("\"measured\":null"), std::string::npos);
    EXPECT_EQ(json["solver"][2]["skipped"], "needs a GPU");
    EXPECT_EQ(json["solver"][2]["pass"], false);
}

TEST(VerifyTable, ShowsMeasuredExpectedAndUnit) {
    CheckList list;
    list.equalRel("E", 1.01, 1, 0.02, "kPa");
    list.atLeast("share", 0.1, 0.5, "1");
    std::ostringstream out;
    printChecks({"solver", list.checks()}, false, out);
    EXPECT_NE(out.str().find("ok"), std::string::npos);
    EXPECT_NE(out.str().find("1 +- 2%"), std::string::npos) << out.str();
    EXPECT_NE(out.str().find("FAIL"), std::string::npos);
    EXPECT_NE(out.str().find("kPa"), std::string::npos);
}

TEST(VerifyGroups, AreThoseThatTheDocumentsName) {
    std::vector<std::string> names;
    for (const VerifyGroup& group : verifyGroups())
        names.push_back(group.name);
    EXPECT_EQ(names, (std::vector<std::string>{"solver", "materials", "fem", "cuts", "stability", "implicit",
                                               "contact", "grasp", "lod", "mapping", "surface", "raycast"}));
}

} // namespace
} // namespace serosa::app
