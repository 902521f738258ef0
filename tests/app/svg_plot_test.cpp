// Ticks, thinning and the texts of numbers, against what they must be for any range.

#include "app/si_text.h"
#include "app/svg_plot.h"
#include "tests/app/page_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace serosa::app {
namespace {

TEST(NiceTicks, CoverTheRangeInRoundSteps) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1), decade(-6, 6);
    for (int i = 0; i < 2000; ++i) {
        const double low = uniform(random) * std::pow(10, decade(random)),
                     high = low + std::abs(low) * 1e-3 + std::pow(10, decade(random));
        const Ticks ticks = niceTicks(low, high, 5);
        const double mantissa = ticks.step / std::pow(10, std::floor(std::log10(ticks.step) + 1e-9));
        EXPECT_TRUE(std::abs(mantissa - 1) < 1e-9 || std::abs(mantissa - 2) < 1e-9 ||
                    std::abs(mantissa - 5) < 1e-9)
            << ticks.step;
        const double slack = 1e-6 * ticks.step;
        ASSERT_GE(ticks.at.size(), 2u);
        EXPECT_LE(ticks.at.size(), 8u);
        EXPECT_LE(ticks.at.front(), low + slack);
        EXPECT_GE(ticks.at.back(), high - slack);
        EXPECT_GT(ticks.at[1], low);
        EXPECT_LT(ticks.at[ticks.at.size() - 2], high);
        for (std::size_t k = 1; k < ticks.at.size(); ++k)
            EXPECT_NEAR(ticks.at[k] - ticks.at[k - 1], ticks.step, 1e-9 * std::abs(high) + slack);
    }
    EXPECT_EQ(niceTicks(0, 8, 5).at, (std::vector<double>{0, 2, 4, 6, 8}));
    EXPECT_EQ(niceTicks(-3, 8, 5).at, (std::vector<double>{-5, 0, 5, 10}));
}

TEST(Thinned, KeepsFirstLowestHighestAndLastOfAPixel) {
    const std::vector<PlotPoint> points{{1.0, 5}, {1.1, 2}, {1.2, 4}, {1.3, 9}, {1.4, 3}, {1.5, 5}, {2.0, 1}};
    std::vector<double> kept;
    for (const PlotPoint& point : thinned(points))
        kept.push_back(point.y);
    EXPECT_EQ(kept, (std::vector<double>{5, 2, 9, 5, 1}));
    std::vector<PlotPoint> sparse;
    for (int i = 0; i < 500; ++i)
        sparse.push_back({i * 1.5, std::sin(i)});
    EXPECT_EQ(thinned(sparse).size(), sparse.size());
    EXPECT_TRUE(thinned({}).empty());
}

TEST(SiText, PrefixesByThousands) {
    const std::string nbsp = "\u00A0";
    EXPECT_EQ(siText(0.02504, "m"), "25.04" + nbsp + "mm");
    EXPECT_EQ(siText(-1.5e-5, "J"), "\u2212"
                                    "15" +
                                        nbsp + "\u00B5J");
    EXPECT_EQ(siText(2600, "Pa"), "2.6" + nbsp + "kPa");
    EXPECT_EQ(siText(1, "N"), "1" + nbsp + "N");
    EXPECT_EQ(siText(0.999949, "m"), "999.9" + nbsp + "mm");
    EXPECT_EQ(siText(0.99996, "m"), "1" + nbsp + "m"); // never 1000 mm
    EXPECT_EQ(siText(0, "J"), "0" + nbsp + "J");
    EXPECT_EQ(siText(3600, "s"), "3600" + nbsp + "s"); // no kiloseconds
    EXPECT_EQ(siText(2.5e30, "J"), "2.5" + nbsp + "\u00D7" + nbsp + "10\u00B3\u2070" + nbsp + "J");
    EXPECT_EQ(siText(4e-20, "N"), "40" + nbsp + "\u00D7" + nbsp + "10\u207B\u00B2\u00B9" + nbsp + "N");
    EXPECT_EQ(siText(std::nan(""), "N"), "not finite");
}

TEST(SiText, Numbers) {
    EXPECT_EQ(numberText(0), "0");
    EXPECT_EQ(numberText(12345), "12345");
    EXPECT_EQ(numberText(123456), "1.235\u00A0\u00D7\u00A010\u2075");
    EXPECT_EQ(numberText(0.00012344), "0.0001234");
    EXPECT_EQ(numberText(1e-5), "1\u00A0\u00D7\u00A010\u207B\u2075");
    EXPECT_EQ(numberText(-2.50), "\u22122.5");
    EXPECT_EQ(numberText(1.7535039, 7), "1.753504");
    EXPECT_EQ(numberText(9.99996), "10");
    EXPECT_EQ(numberText(std::numeric_limits<double>::infinity()), "not finite");
}

TEST(EscapeMarkup, LetsNothingThroughThatIsNoText) {
    EXPECT_EQ(escapeMarkup("a<b>&\"'c"), "a&lt;b&gt;&amp;&quot;&#39;c");
    EXPECT_EQ(escapeMarkup("\u00B5m \u5FC3 \U0001FAC0"), "\u00B5m \u5FC3 \U0001FAC0");
    EXPECT_EQ(escapeMarkup(std::string("\0\x1B\x7F", 3)), "\uFFFD\uFFFD\uFFFD");
    for (const char* bad : {"\xFF", "\x80", "\xC3", "\xF5\x80\x80\x80"}) // no UTF-8, cut short
        EXPECT_TRUE(escapeMarkup(bad).starts_with("\uFFFD")) << bad;
    EXPECT_EQ(escapeMarkup("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD"); // half of a surrogate pair
    EXPECT_EQ(escapeMarkup("\xC0\xBC"
                           "script"),
              "\uFFFD\uFFFDscript");                   // '<' made longer
    EXPECT_EQ(escapeMarkup("\xE2\x80\xAE"), "\uFFFD"); // text from right to left
}

// Whatever a run that goes wrong leaves: no endless loop, and a drawing within its frame.
TEST(Plot, SurvivesExtremeSeries) {
    const double big = std::numeric_limits<double>::max(), tiny = std::numeric_limits<double>::denorm_min(),
                 nan = std::nan("");
    const std::vector<PlotSeries> cases = {{"", {}, {}},
                                           {"", {0}, {0}},
                                           {"", {5}, {1}},
                                           {"", {0, 1}, {big, -big}},
                                           {"", {0, 1}, {tiny, 0}},
                                           {"", {0, 1e-300}, {1, 2}},
                                           {"", {0, 1e9}, {1, 1 + 1e-15}},
                                           {"", {nan, 1}, {1, 2}},
                                           {"", {0, 1, 2}, {nan, nan, nan}},
                                           {"", {1e-300, 2e-300}, {-1e-300, -2e-300}}};
    for (const PlotSeries& series : cases) {
        Markup markup;
        writePlot(markup, {"plot", "Title", "J", "", {series}});
        const std::string text = "<!DOCTYPE html>" + std::move(markup).finish();
        const PageReader page(text);
        EXPECT_EQ(page.error(), "");
        for (const Element* line : page.all("polyline"))
            EXPECT_EQ(line->attribute("points").find_first_not_of("0123456789., "), std::string::npos)
                << line->attribute("points");
        for (const Element* dot : page.all("circle")) {
            EXPECT_GE(std::stod(dot->attribute("cx")), 0);
            EXPECT_LE(std::stod(dot->attribute("cx")), 860);
            EXPECT_GE(std::stod(dot->attribute("cy")), 0);
            EXPECT_LE(std::stod(dot->attribute("cy")), 270);
        }
    }
}

} // namespace
} // namespace serosa::app
