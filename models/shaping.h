#pragma once
// Helpers to model bodies: turned frames, points on a surface, ridges and grooves along lines. Millimetres.

#include "models/sdf.h"

#include <functional>
#include <vector>

namespace serosa::models {

/// A right-handed frame at `at`: y along `up`, z as near to `front` as can be. Both need not be unit.
struct Frame {
    Point at;
    glm::dmat3 worldFromLocal;

    Frame(const Point& origin, const Point& up, const Point& front);
    Point local(const Point& p) const { return glm::transpose(worldFromLocal) * (p - at); }
    Point world(const Point& p) const { return at + worldFromLocal * p; }
};

/// Gradient of `distance` at p, by central differences.
Point gradient(const std::function<double(const Point&)>& distance, const Point& p);

/// The point that Newton steps from p along the gradient reach on the zero set of `distance`.
Point onto(const std::function<double(const Point&)>& distance, Point p);

/// 1 at u = 0, falling smoothly to 0 at |u| = 1: the cross section of a ridge or groove.
inline double bell(double u) {
    const double t = std::max(0.0, 1 - u * u);
    return t * t;
}

/// A smooth curve through points of a plane (Catmull-Rom); low relief is laid along it.
class PlaneCurve {
public:
    explicit PlaneCurve(const std::vector<glm::dvec2>& control, double step = 1.0);

    struct Foot {
        double distance; // to the curve
        double along;    // where the nearest point is, 0 at the first end and 1 at the last
    };
    /// More than kReach away from the curve's box: kReach.
    Foot foot(const glm::dvec2& p) const;
    static constexpr double kReach = 1e3;

private:
    std::vector<glm::dvec2> points_;
    glm::dvec2 lowest_, highest_;
};

/// A plane region inside a smooth closed curve (Catmull-Rom through `control`, either way round): fins,
/// nails.
class Outline {
public:
    explicit Outline(const std::vector<glm::dvec2>& control, double step = 1.0);
    /// Signed distance, negative inside. More than kReach outside the curve's box, the distance to that box.
    double distance(const glm::dvec2& p) const;
    static constexpr double kReach = 12;

private:
    std::vector<glm::dvec2> points_;
    glm::dvec2 lowest_, highest_;
};

} // namespace serosa::models
