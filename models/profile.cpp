// The curve is a spline that is sampled into a polygon; the sign is the parity of crossings to the right.
#include "models/profile.h"

#include "base/check.h"
#include "models/tube.h"

namespace serosa::models {

Profile::Profile(const std::vector<glm::dvec2>& control) {
    SEROSA_CHECK(control.size() >= 3 && control.front().x == 0 && control.back().x == 0,
                 "a profile runs from the axis to the axis");
    // Mirrored about the axis at both ends, so that the curve crosses it at right angles.
    std::vector<TubePoint> drawn;
    const auto add = [&](const glm::dvec2& p, double sign) {
        drawn.push_back({Point(sign * p.x, p.y, 0), 0});
    };
    add(control[1], -1);
    for (const glm::dvec2& p : control)
        add(p, 1);
    add(control[control.size() - 2], -1);
    const std::vector<TubePoint> line = spline(drawn, 0.5);
    for (const TubePoint& p : line)
        points_.emplace_back(p.at.x, p.at.y);
}

double Profile::distance(double radius, double y) const {
    const glm::dvec2 p(radius, y);
    double nearest = 1e18;
    bool inside = false;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
        const glm::dvec2 a = points_[i], b = points_[i + 1], ab = b - a, ap = p - a;
        const double t = std::clamp(glm::dot(ap, ab) / glm::dot(ab, ab), 0.0, 1.0);
        const glm::dvec2 away = ap - t * ab;
        nearest = std::min(nearest, glm::dot(away, away));
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * ab.x)
            inside = !inside;
    }
    return inside ? -std::sqrt(nearest) : std::sqrt(nearest);
}

} // namespace serosa::models
