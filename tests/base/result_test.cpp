// The must-use result type: what it carries, what it refuses, and how errors travel up.

#include "base/result.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <type_traits>

namespace serosa {
namespace {

Result<int> half(int number) {
    if (number % 2 != 0)
        return Error{std::to_string(number) + " is odd", exitBadInput};
    return number / 2;
}

Result<int> quarter(int number) {
    SEROSA_ASSIGN(const int once, half(number));
    SEROSA_ASSIGN(const int twice, half(once));
    return twice;
}

Status even(int number) {
    SEROSA_TRY(half(number));
    return {};
}

TEST(ResultType, HoldsAValueOrAnError) {
    const Result<int> good = half(8);
    ASSERT_TRUE(good.ok());
    EXPECT_TRUE(static_cast<bool>(good));
    EXPECT_EQ(good.value(), 4);
    EXPECT_EQ(*good, 4);
    const Result<int> bad = half(7);
    ASSERT_FALSE(bad.ok());
    EXPECT_EQ(bad.error().message, "7 is odd");
    EXPECT_EQ(bad.error().exitCode, 2);
}

TEST(ResultType, AssignStopsAtTheFirstError) {
    EXPECT_EQ(quarter(12).value(), 3);
    EXPECT_EQ(quarter(6).error().message, "3 is odd");
    EXPECT_EQ(quarter(5).error().message, "5 is odd");
}

TEST(ResultType, TryTurnsAResultIntoAStatus) {
    EXPECT_TRUE(even(2).ok());
    EXPECT_EQ(even(3).error().message, "3 is odd");
}

TEST(ResultType, TheExitCodeTravelsWithTheError) {
    const auto fail = []() -> Status { return Error{"no context", exitNoGl}; };
    const auto outer = [&]() -> Result<std::string> {
        SEROSA_TRY(fail());
        return std::string("unreached");
    };
    EXPECT_EQ(outer().error().exitCode, 5);
}

TEST(ResultType, MoveOnlyValuesComeOut) {
    Result<std::unique_ptr<int>> result = std::make_unique<int>(7);
    EXPECT_EQ(**result, 7);
    const std::unique_ptr<int> taken = std::move(result).value();
    EXPECT_EQ(*taken, 7);
}

TEST(ResultTypeDeathTest, ReadingTheWrongOneAborts) {
    EXPECT_DEATH(static_cast<void>(half(7).value()), "check failed.*7 is odd");
    EXPECT_DEATH(static_cast<void>(half(8).error()), "holds a value");
    EXPECT_DEATH(static_cast<void>(Status().error()), "success");
}

} // namespace
} // namespace serosa
