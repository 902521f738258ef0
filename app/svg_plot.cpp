// See app/svg_plot.h.

#include "app/svg_plot.h"

#include "app/si_text.h"
#include "base/check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace serosa::app {

namespace {

// The drawing's own pixels; the page scales it to its width.
constexpr double kWidth = 860, kHeight = 270;
constexpr double kLeft = 64, kRight = 16, kTop = 12, kBottom = 40;
constexpr double kThinWidth = 1; // pixels: samples closer than this are one column
constexpr std::size_t kColours = 8;

std::string pixels(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    std::string digits(text);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.ends_with('.'))
        digits.pop_back();
    return digits == "-0" ? "0" : digits;
}

/// All ticks of an axis with the same number of decimals.
std::string tickText(double value, double step) {
    const int decimals = std::max(0, int(-std::floor(std::log10(step) + 1e-9)));
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, std::abs(value));
    return (value < 0 ? "\u2212" : "") + std::string(text);
}

struct Axis {
    SiScale scale;
    double low = 0, high = 1;           // in the scale's unit
    double lowPixel = 0, highPixel = 1; // where they lie
    Ticks ticks;

    double pixel(double si) const {
        return lowPixel + (si * scale.factor - low) / (high - low) * (highPixel - lowPixel);
    }
    double tickPixel(double tick) const {
        return lowPixel + (tick - low) / (high - low) * (highPixel - lowPixel);
    }
};

struct Range {
    double low = 0, high = 0;
    bool any = false;
    void add(double value) {
        if (!std::isfinite(value))
            return;
        low = any ? std::min(low, value) : value;
        high = any ? std::max(high, value) : value;
        any = true;
    }
};

Axis timeAxis(const Plot& plot) {
    Range range;
    range.add(0);
    range.add(plot.end);
    for (const PlotSeries& series : plot.series)
        for (const double time : series.times)
            range.add(time);
    Axis axis;
    axis.scale = siScale(std::max(std::abs(range.low), std::abs(range.high)), "s");
    axis.low = range.low * axis.scale.factor;
    axis.high = range.high * axis.scale.factor;
    if (!(axis.high - axis.low > 1e-6 * std::abs(axis.high)))
        axis.high = axis.low + std::max(1.0, std::abs(axis.low));
    axis.lowPixel = kLeft;
    axis.highPixel = kWidth - kRight;
    axis.ticks = niceTicks(axis.low, axis.high, 8);
    const double slack = 1e-9 * axis.ticks.step; // the axis ends with the run, not with a tick
    std::erase_if(axis.ticks.at,
                  [&](double tick) { return tick < axis.low - slack || tick > axis.high + slack; });
    return axis;
}

/// Zero is always on it: every quantity of a run is measured from rest.
Axis valueAxis(const Plot& plot) {
    Range range;
    range.add(0);
    for (const PlotSeries& series : plot.series)
        for (const double value : series.values)
            range.add(value);
    Axis axis;
    axis.scale = siScale(std::max(-range.low, range.high), plot.unit);
    const double low = range.low * axis.scale.factor, high = range.high * axis.scale.factor;
    axis.ticks = niceTicks(low, low < high ? high : low + 1, 5);
    axis.low = axis.ticks.at.front();
    axis.high = axis.ticks.at.back();
    axis.lowPixel = kHeight - kBottom;
    axis.highPixel = kTop;
    return axis;
}

void writeAxes(Markup& page, const Axis& time, const Axis& value) {
    page.open("g", {{"class", "grid"}});
    for (const double tick : value.ticks.at) {
        const std::string y = pixels(value.tickPixel(tick));
        page.empty("line", {{"class", tick == 0 ? "zero" : "rule"},
                            {"x1", pixels(kLeft)},
                            {"x2", pixels(kWidth - kRight)},
                            {"y1", y},
                            {"y2", y}});
    }
    for (const double tick : time.ticks.at) {
        const std::string x = pixels(time.tickPixel(tick));
        page.empty("line", {{"class", "tick"},
                            {"x1", x},
                            {"x2", x},
                            {"y1", pixels(kHeight - kBottom)},
                            {"y2", pixels(kHeight - kBottom + 5)}});
    }
    page.close();
    page.open("g", {{"class", "labels value"}, {"text-anchor", "end"}});
    for (const double tick : value.ticks.at)
        page.element("text",
                     {{"x", pixels(kLeft - 8)}, {"y", pixels(value.tickPixel(tick))}, {"dy", "0.35em"}},
                     tickText(tick, value.ticks.step));
    page.close();
    page.open("g", {{"class", "labels time"}, {"text-anchor", "middle"}});
    for (const double tick : time.ticks.at) {
        const bool last = tick == time.ticks.at.back(); // the unit stands behind the last label
        page.element(
            "text",
            {{"x", pixels(time.tickPixel(tick))}, {"y", pixels(kHeight - kBottom + 9)}, {"dy", "1em"}},
            tickText(tick, time.ticks.step) + (last ? "\u00A0" + time.scale.name : ""));
    }
    page.close();
}

std::string pointText(const PlotSeries& series, std::size_t i, const std::string& unit) {
    return series.name + ": " + siText(series.values[i], unit) + " at " + siText(series.times[i], "s");
}

/// Index of the value of largest size; none where all are zero or not finite.
std::optional<std::size_t> peakOf(const PlotSeries& series) {
    std::optional<std::size_t> peak;
    double largest = 0;
    for (std::size_t i = 0; i < series.values.size(); ++i)
        if (std::isfinite(series.values[i]) && std::abs(series.values[i]) > largest) {
            largest = std::abs(series.values[i]);
            peak = i;
        }
    return peak;
}

void writeDot(Markup& page, const char* kind, double x, double y, const std::string& title) {
    page.open("circle", {{"class", kind}, {"cx", pixels(x)}, {"cy", pixels(y)}, {"r", "2.6"}});
    page.element("title", {}, title).close();
}

std::string seriesClass(std::size_t index) {
    return "s" + std::to_string(index % kColours + 1);
}

void writeSeries(Markup& page, const PlotSeries& series, std::size_t index, const Axis& time,
                 const Axis& value, const std::string& unit) {
    page.open("g", {{"class", "series " + seriesClass(index)}});
    std::vector<PlotPoint> stretch;
    const auto finish = [&] {
        if (stretch.size() > 1) {
            std::string points;
            for (const PlotPoint& point : thinned(stretch))
                points += (points.empty() ? "" : " ") + pixels(point.x) + "," + pixels(point.y);
            page.empty("polyline", {{"points", points}});
        }
        stretch.clear();
    };
    const auto finite = [&](std::size_t i) {
        return i < series.values.size() && std::isfinite(series.values[i]) && std::isfinite(series.times[i]);
    };
    const bool marked = series.values.size() <= kMarkedPoints;
    const std::optional<std::size_t> peak = peakOf(series);
    std::vector<std::size_t> dots;
    for (std::size_t i = 0; i < series.values.size(); ++i) {
        if (!finite(i)) {
            finish();
            continue;
        }
        stretch.push_back({time.pixel(series.times[i]), value.pixel(series.values[i])});
        const bool alone = stretch.size() == 1 && !finite(i + 1);
        if (marked || alone || i == peak)
            dots.push_back(i);
    }
    finish();
    for (const std::size_t i : dots)
        writeDot(page, i == peak ? "peak" : "dot", time.pixel(series.times[i]), value.pixel(series.values[i]),
                 pointText(series, i, unit));
    page.close();
}

void writeLegend(Markup& page, const Plot& plot) {
    page.open("ul", {{"class", "legend"}});
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const PlotSeries& series = plot.series[i];
        page.open("li");
        page.open("svg", {{"class", "swatch"}, {"viewBox", "0 0 26 10"}, {"aria-hidden", "true"}});
        page.open("g", {{"class", "series " + seriesClass(i)}});
        page.empty("line", {{"x1", "1"}, {"x2", "25"}, {"y1", "5"}, {"y2", "5"}}).close().close();
        page.element("span", {{"class", "name"}}, series.name);
        const std::optional<std::size_t> peak = peakOf(series);
        const bool anyFinite = std::any_of(series.values.begin(), series.values.end(),
                                           [](double value) { return std::isfinite(value); });
        page.text(" ");
        page.element("span", {{"class", "extreme"}},
                     peak ? (series.values[*peak] < 0 ? "lowest " : "highest ") +
                                siText(series.values[*peak], plot.unit) + " at " +
                                siText(series.times[*peak], "s")
                     : anyFinite ? "0 throughout"
                                 : "no finite value");
        page.close();
    }
    page.close();
}

} // namespace

Ticks niceTicks(double low, double high, int count) {
    SEROSA_CHECK(std::isfinite(low) && std::isfinite(high) && count > 0, "a range to divide");
    SEROSA_CHECK(high - low > 1e-9 * std::max(std::abs(low), std::abs(high)), "a range wider than rounding");
    const double rough = (high - low) / count;
    const double decade = std::pow(10.0, std::floor(std::log10(rough)));
    const double share = rough / decade;
    Ticks ticks;
    ticks.step = decade * (share <= 1.0 ? 1 : share <= 2.0 ? 2 : share <= 5.0 ? 5 : 10);
    const double first = std::floor(low / ticks.step + 1e-9), last = std::ceil(high / ticks.step - 1e-9);
    for (double i = first; i <= last; ++i)
        ticks.at.push_back(i == 0 ? 0 : i * ticks.step);
    return ticks;
}

std::vector<PlotPoint> thinned(const std::vector<PlotPoint>& points) {
    std::vector<PlotPoint> kept;
    for (std::size_t begin = 0; begin < points.size();) {
        const double column = std::floor(points[begin].x / kThinWidth);
        std::size_t end = begin + 1, lowest = begin, highest = begin;
        for (; end < points.size() && std::floor(points[end].x / kThinWidth) == column; ++end) {
            if (points[end].y < points[lowest].y)
                lowest = end;
            if (points[end].y > points[highest].y)
                highest = end;
        }
        std::vector<std::size_t> some{begin, lowest, highest, end - 1};
        std::sort(some.begin(), some.end());
        some.erase(std::unique(some.begin(), some.end()), some.end());
        for (const std::size_t i : some)
            kept.push_back(points[i]);
        begin = end;
    }
    return kept;
}

void writePlot(Markup& page, const Plot& plot) {
    const Axis time = timeAxis(plot), value = valueAxis(plot);
    page.open("figure", {{"class", "plot"}, {"id", plot.id}});
    page.open("figcaption");
    page.element("strong", {}, plot.title).text(" ");
    page.element("span", {{"class", "unit"}}, "in " + value.scale.name).text(" ");
    page.element("span", {{"class", "note"}}, plot.note);
    page.close();
    writeLegend(page, plot);
    page.open("svg",
              {{"viewBox", "0 0 " + pixels(kWidth) + " " + pixels(kHeight)},
               {"role", "img"},
               {"aria-label", plot.title + " in " + value.scale.name + " over time in " + time.scale.name}});
    writeAxes(page, time, value);
    for (std::size_t i = plot.series.size(); i-- > 0;)
        writeSeries(page, plot.series[i], i, time, value, plot.unit);
    page.close().close();
}

} // namespace serosa::app
