// The helpers of shaping.h that need more than a line.
#include "models/shaping.h"

#include "models/tube.h"

namespace serosa::models {

Frame::Frame(const Point& origin, const Point& up, const Point& front) : at(origin) {
    const Point y = glm::normalize(up), x = glm::normalize(glm::cross(y, front));
    worldFromLocal = glm::dmat3(x, y, glm::cross(x, y));
}

Point gradient(const std::function<double(const Point&)>& distance, const Point& p) {
    constexpr double e = 1e-3;
    Point g;
    for (int axis = 0; axis < 3; ++axis) {
        Point step(0);
        step[axis] = e;
        g[axis] = (distance(p + step) - distance(p - step)) / (2 * e);
    }
    return g;
}

Point onto(const std::function<double(const Point&)>& distance, Point p) {
    for (int step = 0; step < 40; ++step) {
        const double d = distance(p);
        if (std::abs(d) < 1e-9)
            break;
        const Point g = gradient(distance, p);
        p -= d / std::max(glm::dot(g, g), 1e-3) * g;
    }
    return p;
}

PlaneCurve::PlaneCurve(const std::vector<glm::dvec2>& control, double step) : lowest_(1e9), highest_(-1e9) {
    std::vector<TubePoint> flat;
    for (const glm::dvec2& c : control)
        flat.push_back({Point(c, 0), 0});
    for (const TubePoint& p : spline(flat, step)) {
        points_.emplace_back(p.at);
        lowest_ = glm::min(lowest_, points_.back());
        highest_ = glm::max(highest_, points_.back());
    }
}

PlaneCurve::Foot PlaneCurve::foot(const glm::dvec2& p) const {
    constexpr double near = 30; // wider than any relief
    if (glm::length(glm::max(glm::max(lowest_ - p, p - highest_), 0.0)) > near)
        return {kReach, 0};
    Foot best{kReach, 0};
    const double pieces = static_cast<double>(points_.size() - 1);
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
        const glm::dvec2 a = points_[i], ab = points_[i + 1] - a;
        const double t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
        const double d = glm::length(p - a - t * ab);
        if (d < best.distance)
            best = {d, (static_cast<double>(i) + t) / pieces};
    }
    return best;
}

Outline::Outline(const std::vector<glm::dvec2>& control, double step) : lowest_(1e9), highest_(-1e9) {
    // The spline runs on past both ends and is cut where it repeats.
    const std::size_t n = control.size();
    std::vector<TubePoint> round;
    for (std::size_t i = 0; i < n + 3; ++i)
        round.push_back({Point(control[(i + n - 1) % n], static_cast<double>(i)), 0});
    for (const TubePoint& p : spline(round, step))
        if (p.at.z >= 1 && p.at.z < static_cast<double>(n) + 1) {
            points_.emplace_back(p.at);
            lowest_ = glm::min(lowest_, points_.back());
            highest_ = glm::max(highest_, points_.back());
        }
}

double Outline::distance(const glm::dvec2& p) const {
    const double away = glm::length(glm::max(glm::max(lowest_ - p, p - highest_), 0.0));
    if (away > kReach)
        return away;
    double best = 1e18;
    bool inside = false;
    for (std::size_t i = 0, j = points_.size() - 1; i < points_.size(); j = i++) {
        const glm::dvec2 a = points_[j], b = points_[i], ab = b - a;
        const double t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
        const glm::dvec2 q = p - a - t * ab;
        best = std::min(best, glm::dot(q, q));
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + ab.x * (p.y - a.y) / ab.y)
            inside = !inside;
    }
    return inside ? -std::sqrt(best) : std::sqrt(best);
}

} // namespace serosa::models
