// Quantities: a number and a unit, in SI. Expected values are worked out by hand from the units' definitions.

#include "sim/quantity.h"
#include "sim/scene.h"
#include "sim/suggest.h"

#include <gtest/gtest.h>

namespace serosa::sim {
namespace {

double parsed(const char* text, Dimension dimension) {
    const Result<double> result = parseQuantity(text, dimension);
    EXPECT_TRUE(result.ok()) << text << ": " << (result.ok() ? "" : result.error().message);
    return result.ok() ? *result : -12345;
}

std::string problem(const std::string& text, Dimension dimension) {
    const Result<double> result = parseQuantity(text, dimension);
    EXPECT_FALSE(result.ok()) << text << " gave " << (result.ok() ? *result : 0);
    return result.ok() ? "" : result.error().message;
}

TEST(Quantity, GivesSiUnits) {
    EXPECT_DOUBLE_EQ(parsed("3 kPa", Dimension::pressure), 3000);
    EXPECT_DOUBLE_EQ(parsed("2.5 mm", Dimension::length), 0.0025);
    EXPECT_DOUBLE_EQ(parsed("1 in", Dimension::length), 0.0254);
    EXPECT_DOUBLE_EQ(parsed("60 Hz", Dimension::frequency), 60);
    EXPECT_DOUBLE_EQ(parsed("-9.81 m/s2", Dimension::acceleration), -9.81);
    EXPECT_DOUBLE_EQ(parsed("180 deg", Dimension::angle), 3.14159265358979323846);
    EXPECT_DOUBLE_EQ(parsed("1060 kg/m3", Dimension::density), 1060);
    EXPECT_DOUBLE_EQ(parsed("1.06 g/cm3", Dimension::density), 1060);
    EXPECT_DOUBLE_EQ(parsed("2 ms", Dimension::time), 0.002);
    EXPECT_DOUBLE_EQ(parsed("0.5 1/s", Dimension::rate), 0.5);
}

TEST(Quantity, TakesBlanksSignsAndExponents) {
    EXPECT_DOUBLE_EQ(parsed("  +4mm ", Dimension::length), 0.004);
    EXPECT_DOUBLE_EQ(parsed("1e3 um", Dimension::length), 0.001);
    EXPECT_DOUBLE_EQ(parsed("-0.5 \t cm", Dimension::length), -0.005);
}

TEST(Quantity, RefusesWhatIsNoQuantityAndSaysWhatToDo) {
    EXPECT_NE(problem("3", Dimension::pressure).find("no unit"), std::string::npos);
    EXPECT_NE(problem("3", Dimension::pressure).find("kPa"), std::string::npos);
    EXPECT_NE(problem("2,5 mm", Dimension::length).find("write a point"), std::string::npos);
    EXPECT_NE(problem("3 kpa", Dimension::pressure).find("did you mean 'kPa'"), std::string::npos);
    EXPECT_NE(problem("3 furlongs", Dimension::length).find("known: mm"), std::string::npos);
    EXPECT_NE(problem("3 mm", Dimension::pressure).find("is a length"), std::string::npos);
    for (const char* text :
         {"", "  ", "mm", "+-3 mm", "++3 mm", "0x10 mm", "1e400 mm", "nan mm", "inf mm", "3 mm mm", "3 mm;"})
        problem(text, Dimension::length);
    EXPECT_NE(problem("1e308 GPa", Dimension::pressure).find("finite"), std::string::npos);
}

TEST(Quantity, MessagesAreOneShortLine) {
    const std::string message = problem("3 \n" + std::string(5000, 'x'), Dimension::length);
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_LT(message.size(), 200u);
}

TEST(Quantity, FormattedReadsBackAsTheSameDouble) {
    for (const double value : {0.1, 1.0 / 3, 1e-300, 6.02e23, -0.0025})
        EXPECT_EQ(parsed(formatQuantity(value, Dimension::length).c_str(), Dimension::length), value);
}

TEST(Quantity, LengthUnits) {
    EXPECT_DOUBLE_EQ(*parseLengthUnit("cm"), 0.01);
    const auto wrong = parseLengthUnit("MM");
    ASSERT_FALSE(wrong.ok());
    EXPECT_NE(wrong.error().message.find("did you mean 'mm'"), std::string::npos);
    EXPECT_FALSE(parseLengthUnit("").ok());
}

TEST(Suggest, EditDistanceOfKnownPairs) {
    EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
    EXPECT_EQ(editDistance("yuong", "young"), 1u); // a swap of neighbours
    EXPECT_EQ(editDistance("", "abc"), 3u);
    EXPECT_EQ(editDistance("same", "same"), 0u);
}

TEST(Suggest, NearestOrNone) {
    EXPECT_EQ(nearestWord("densty", {"young", "density"}), "density");
    EXPECT_EQ(nearestWord("qqqqqq", {"young", "density"}), "");
    EXPECT_EQ(nearestWord(std::string(100000, 'a'), {"young"}), "");
}

} // namespace
} // namespace serosa::sim
