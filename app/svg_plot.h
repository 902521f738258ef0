#pragma once
// A plot of quantities over time as a figure with inline SVG: axes in SI units with the prefix that suits
// them, ticks at 1, 2 or 5 times a power of ten, a legend with each largest value. Colours, print and dark
// mode are the page's style sheet (app/report_style.cpp).

#include "app/markup.h"

#include <cstddef>
#include <string>
#include <vector>

namespace serosa::app {

/// Series of at most so many samples have a dot for each.
constexpr std::size_t kMarkedPoints = 90;

/// times and values in SI units, of one length, times ascending. A value that is not finite makes a gap.
struct PlotSeries {
    std::string name;
    std::vector<double> times, values;
};

struct Plot {
    std::string id, title, unit; // unit of the values: "J"
    std::string note;            // behind the title: what was sampled, how often
    std::vector<PlotSeries> series;
    double end = 0; // s: the time axis goes from 0 to here at least, so that plots below each other compare
};

/// Writes `plot` as <figure class="plot">. One polyline a stretch of finite values, in
/// <g class="series s1">, s2 ... s8, s1 ..., the first series on top; long series are thinned (thinned()).
void writePlot(Markup& page, const Plot& plot);

/// Ascending ticks of `step` = 1, 2 or 5 times a power of ten, about `count` of them; the first is at or
/// below `low`, the last at or above `high`. Both finite, low < high.
struct Ticks {
    double step = 1;
    std::vector<double> at;
};
Ticks niceTicks(double low, double high, int count);

struct PlotPoint {
    double x = 0, y = 0; // pixels of the plot
};
/// `points` (x ascending) with at most the first, lowest, highest and last of every pixel's width kept,
/// in their order: no peak is lost, and the line looks the same.
std::vector<PlotPoint> thinned(const std::vector<PlotPoint>& points);

} // namespace serosa::app
