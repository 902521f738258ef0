// Chains of tapering capsules, and the grid that finds the near ones of many.
#include "models/tube.h"

#include "base/check.h"

namespace serosa::models {

std::vector<TubePoint> spline(const std::vector<TubePoint>& control, double step) {
    SEROSA_CHECK(control.size() >= 2, "a spline needs two points");
    std::vector<TubePoint> out;
    const int last = static_cast<int>(control.size()) - 1;
    const auto at = [&](int i) {
        if (i < 0)
            return TubePoint{2.0 * control[0].at - control[1].at, control[0].radius};
        if (i > last)
            return TubePoint{2.0 * control[last].at - control[last - 1].at, control[last].radius};
        return control[i];
    };
    const auto mix = [](double a, double b, double c, double d, double t) {
        return 0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) +
                      t * t * t * (3 * b - a - 3 * c + d));
    };
    for (int i = 0; i < last; ++i) {
        const TubePoint a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
        const int pieces = std::max(1, static_cast<int>(std::ceil(glm::length(c.at - b.at) / step)));
        for (int k = 0; k < pieces; ++k) {
            const double t = static_cast<double>(k) / pieces;
            const Point p(mix(a.at.x, b.at.x, c.at.x, d.at.x, t), mix(a.at.y, b.at.y, c.at.y, d.at.y, t),
                          mix(a.at.z, b.at.z, c.at.z, d.at.z, t));
            out.push_back({p, b.radius + (c.radius - b.radius) * t});
        }
    }
    out.push_back(control[last]);
    return out;
}

Tube::Tube(std::vector<TubePoint> points, End start, End finish, double beyond) : points_(std::move(points)) {
    SEROSA_CHECK(points_.size() >= 2, "a tube needs two points");
    const auto stump = [&](const TubePoint& end, const TubePoint& before) {
        stumps_.push_back({end.at, glm::normalize(end.at - before.at), end.radius + beyond, end.radius});
    };
    if (start == End::flat)
        stump(points_.front(), points_[1]);
    if (finish == End::flat)
        stump(points_.back(), points_[points_.size() - 2]);
    lowest_ = highest_ = points_.front().at;
    const auto include = [&](const Point& p, double r) {
        lowest_ = glm::min(lowest_, p - r);
        highest_ = glm::max(highest_, p + r);
    };
    for (const TubePoint& p : points_)
        include(p.at, p.radius);
    for (const Stump& s : stumps_)
        include(s.from + s.length * s.direction, s.radius);
    constexpr std::size_t kRun = 5;
    for (std::size_t first = 0; first + 1 < points_.size(); first += kRun) {
        Run run{first, std::min(first + kRun, points_.size() - 1), Point(0), 0};
        run.centre = 0.5 * (points_[run.first].at + points_[run.last].at);
        for (std::size_t i = run.first; i <= run.last; ++i)
            run.radius = std::max(run.radius, glm::length(points_[i].at - run.centre) + points_[i].radius);
        runs_.push_back(run);
    }
}

double Tube::distance(const Point& p) const {
    const double away = glm::length(glm::max(glm::max(lowest_ - p, p - highest_), 0.0));
    if (away > kReach)
        return away;
    double best = 1e9;
    for (const Run& run : runs_) {
        if (glm::length(p - run.centre) - run.radius > best)
            continue;
        for (std::size_t i = run.first; i < run.last; ++i)
            best = std::min(
                best, capsule(p, points_[i].at, points_[i + 1].at, points_[i].radius, points_[i + 1].radius));
    }
    for (const Stump& s : stumps_) {
        const double along = glm::dot(p - s.from, s.direction);
        const double beside = glm::length(p - s.from - along * s.direction) - s.radius;
        best = std::min(best, common(std::max(beside, -along), along - s.length, 1.5));
    }
    return best;
}

void TubeTree::add(const std::vector<TubePoint>& points) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        segments_.push_back({points[i], points[i + 1]});
}

void TubeTree::build() {
    Point highest = lowest_ = segments_.empty() ? Point(0) : segments_.front().a.at;
    const auto box = [](const Segment& s, Point& lo, Point& hi) {
        const double r = std::max(s.a.radius, s.b.radius) + kReach;
        lo = glm::min(s.a.at, s.b.at) - r;
        hi = glm::max(s.a.at, s.b.at) + r;
    };
    for (const Segment& s : segments_) {
        Point lo, hi;
        box(s, lo, hi);
        lowest_ = glm::min(lowest_, lo);
        highest = glm::max(highest, hi);
    }
    size_ = glm::ivec3((highest - lowest_) / kCell) + 1;
    cells_.assign(static_cast<std::size_t>(size_.x) * size_.y * size_.z, {});
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        Point lo, hi;
        box(segments_[i], lo, hi);
        const glm::ivec3 from((lo - lowest_) / kCell), to((hi - lowest_) / kCell);
        for (int z = from.z; z <= std::min(to.z, size_.z - 1); ++z)
            for (int y = from.y; y <= std::min(to.y, size_.y - 1); ++y)
                for (int x = from.x; x <= std::min(to.x, size_.x - 1); ++x)
                    cells_[(static_cast<std::size_t>(z) * size_.y + y) * size_.x + x].push_back(
                        static_cast<int>(i));
    }
}

double TubeTree::distance(const Point& p) const {
    const Point q = (p - lowest_) / kCell;
    if (q.x < 0 || q.y < 0 || q.z < 0 || q.x >= size_.x || q.y >= size_.y || q.z >= size_.z)
        return kReach;
    double best = kReach;
    const glm::ivec3 c(q);
    for (int i : cells_[(static_cast<std::size_t>(c.z) * size_.y + c.y) * size_.x + c.x])
        best = std::min(best, capsule(p, segments_[i].a.at, segments_[i].b.at, segments_[i].a.radius,
                                      segments_[i].b.radius));
    return best;
}

} // namespace serosa::models
