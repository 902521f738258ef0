// The lumen is the end of the same spline, thinner by the wall and longer than the cut.
#include "models/stump.h"

namespace serosa::models {
namespace {

constexpr double kStep = 0.8; // mm between samples of a centre line

std::vector<TubePoint> lumenOf(const std::vector<TubePoint>& control, double wall, double open) {
    const std::vector<TubePoint> line = spline(control, kStep);
    // The flat end stands its own radius beyond the last point.
    double length = line.back().radius;
    std::size_t first = line.size() - 1;
    while (first > 0 && (length < open || first + 2 > line.size())) {
        --first;
        length += glm::length(line[first + 1].at - line[first].at);
    }
    std::vector<TubePoint> end(line.begin() + static_cast<std::ptrdiff_t>(first), line.end());
    for (TubePoint& p : end)
        p.radius -= wall;
    return end;
}

} // namespace

Stump::Stump(const std::vector<TubePoint>& control, double wall, double open)
    : outer_(spline(control, kStep), Tube::End::round, Tube::End::flat, 0.0),
      lumen_(lumenOf(control, wall, open), Tube::End::round, Tube::End::flat, 2 * wall + 2.0) {}

} // namespace serosa::models
