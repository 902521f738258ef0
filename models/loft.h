#pragma once
// Long bodies from cross sections: ellipses (or squarer curves) whose centre and half sizes run smoothly
// along an axis. The trunk of a fish or of a man.

#include "models/sdf.h"

#include <vector>

namespace serosa::models {

/// A cross section at `s` along the axis: its centre (x, y), half sizes (x, y) in the section's plane.
struct LoftSection {
    double s;
    glm::dvec2 centre, half;
    double squareness = 2; // exponent of the superellipse: 2 is an ellipse
};

class Loft {
public:
    /// At least two sections with growing s. The body ends along the axis at the first and the last. Beyond
    /// the first and the last the body is closed by half ellipsoids of the lengths `startCap` and `endCap`
    /// (greater than 0).
    Loft(std::vector<LoftSection> sections, double startCap, double endCap);

    /// Distance at (x, y) in the section's plane at s along the axis: exact to first order at the surface;
    /// elsewhere at most about 1 mm more than the true distance.
    double distance(const Point& xys) const;

    /// The section at s, interpolated.
    LoftSection at(double s) const;

private:
    double radius(const Point& xys) const; // 0 on the axis, 1 on the surface

    std::vector<LoftSection> sections_, slopes_;
    double startCap_, endCap_;
    Point lowest_, highest_;
};

} // namespace serosa::models
