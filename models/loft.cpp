// A cubic spline through the sections; the distance is the implicit function over its gradient's length.
#include "models/loft.h"

#include "base/check.h"

namespace serosa::models {
namespace {

LoftSection combine(double a, const LoftSection& x, double b, const LoftSection& y) {
    return {0, a * x.centre + b * y.centre, a * x.half + b * y.half, a * x.squareness + b * y.squareness};
}

} // namespace

Loft::Loft(std::vector<LoftSection> sections, double startCap, double endCap)
    : sections_(std::move(sections)), startCap_(startCap), endCap_(endCap), lowest_(1e9), highest_(-1e9) {
    SEROSA_CHECK(sections_.size() >= 2 && startCap > 0 && endCap > 0, "a loft needs two sections and caps");
    // Slopes of the cubic spline with continuous curvature whose ends run along the axis, as the caps do
    // (elimination from the first interior section on, then back).
    const std::size_t n = sections_.size();
    const LoftSection none{0, {0, 0}, {0, 0}, 0};
    slopes_.assign(n, none);
    std::vector<double> pivot(n, 1.0);
    const auto gap = [&](std::size_t i) { return sections_[i + 1].s - sections_[i].s; };
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double a = 1 / gap(i - 1), b = 1 / gap(i);
        const LoftSection before = combine(3 * a * a, sections_[i], -3 * a * a, sections_[i - 1]);
        const LoftSection after = combine(3 * b * b, sections_[i + 1], -3 * b * b, sections_[i]);
        pivot[i] = 2 * (a + b);
        slopes_[i] = combine(1, before, 1, after);
        if (i > 1) {
            const double share = a / pivot[i - 1];
            pivot[i] -= share * a;
            slopes_[i] = combine(1, slopes_[i], -share, slopes_[i - 1]);
        }
    }
    for (std::size_t i = n - 2; i >= 1; --i)
        slopes_[i] = combine(1 / pivot[i], slopes_[i], -1 / (gap(i) * pivot[i]), slopes_[i + 1]);
    for (const LoftSection& section : sections_) {
        lowest_ = glm::min(lowest_, Point(section.centre - 1.1 * section.half, section.s - startCap));
        highest_ = glm::max(highest_, Point(section.centre + 1.1 * section.half, section.s + endCap));
    }
}

LoftSection Loft::at(double s) const {
    s = std::clamp(s, sections_.front().s, sections_.back().s);
    std::size_t i = 0;
    while (i + 2 < sections_.size() && s > sections_[i + 1].s)
        ++i;
    const double h = sections_[i + 1].s - sections_[i].s, t = (s - sections_[i].s) / h;
    const double t2 = t * t, t3 = t2 * t;
    const LoftSection values = combine(2 * t3 - 3 * t2 + 1, sections_[i], 3 * t2 - 2 * t3, sections_[i + 1]);
    const LoftSection bends = combine((t3 - 2 * t2 + t) * h, slopes_[i], (t3 - t2) * h, slopes_[i + 1]);
    LoftSection out = combine(1, values, 1, bends);
    out.s = s;
    return out;
}

double Loft::radius(const Point& p) const {
    const LoftSection section = at(p.z);
    const double beyond = p.z < section.s ? (section.s - p.z) / startCap_ : (p.z - section.s) / endCap_;
    const glm::dvec2 q = glm::abs(glm::dvec2(p) - section.centre) / section.half;
    const double n = section.squareness;
    const double ring = n == 2 ? glm::length(q) : std::pow(std::pow(q.x, n) + std::pow(q.y, n), 1 / n);
    return std::hypot(ring, beyond);
}

double Loft::distance(const Point& p) const {
    const double away = glm::length(glm::max(glm::max(lowest_ - p, p - highest_), 0.0));
    if (away > 60) // farther than any blend looks
        return away;
    constexpr double e = 1e-4;
    const double r = radius(p);
    const Point g = Point(radius(p + Point(e, 0, 0)) - r, radius(p + Point(0, e, 0)) - r,
                          radius(p + Point(0, 0, e)) - r) /
                    e;
    const double first = (r - 1) / std::max(glm::length(g), 1e-6);
    if (r >= 1)
        return first;
    // Deep inside, the first order overestimates: the least half size bounds the depth from below.
    const LoftSection section = at(p.z);
    const double ends = std::min(startCap_ + std::max(0.0, p.z - sections_.front().s),
                                 endCap_ + std::max(0.0, sections_.back().s - p.z));
    const double least = std::min({section.half.x, section.half.y, ends});
    return std::max(first, -(1 - r) * least - 1);
}

} // namespace serosa::models
