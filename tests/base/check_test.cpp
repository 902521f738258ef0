// SEROSA_CHECK stands in release builds too, names the place, and costs nothing when it holds.

#include "base/check.h"

#include <gtest/gtest.h>

#include <string>

namespace serosa {
namespace {

TEST(CheckDeathTest, NamesFileConditionAndMessage) {
    const int nodes = 3;
    EXPECT_DEATH(SEROSA_CHECK(nodes == 4, "four nodes, got " + std::to_string(nodes)),
                 "check_test\\.cpp:[0-9]+: check failed: nodes == 4: four nodes, got 3");
}

TEST(Check, EvaluatesTheConditionOnceAndTheMessageOnlyOnFailure) {
    int conditions = 0, messages = 0;
    const auto message = [&] {
        ++messages;
        return std::string("unreached");
    };
    SEROSA_CHECK(++conditions == 1, message());
    EXPECT_EQ(conditions, 1);
    EXPECT_EQ(messages, 0);
}

TEST(Check, IsOneStatement) {
    bool reached = false;
    if (false)
        SEROSA_CHECK(false, "not run");
    else
        reached = true; // would not compile if the macro were two statements
    EXPECT_TRUE(reached);
}

} // namespace
} // namespace serosa
