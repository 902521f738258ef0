#pragma once
// A small toolkit of signed distance functions: negative inside, gradient of length at most one (up to 10%
// more along tapering tubes), exact or nearly so close to the surface. Lengths are millimetres throughout
// models/.
//
// Shapes are plain functions of a point; they compose with `blend` (union), `common` (intersection) and
// `carve` (subtraction), each with a blend radius: the fillet touches nothing where the two distances differ
// by more than it.

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace serosa::models {

using Point = glm::dvec3;

/// Union with a fillet of blend radius k (0: sharp). Never above min(a, b), at most k/4 below.
inline double blend(double a, double b, double k) {
    const double h = k > 0 ? std::max(k - std::abs(a - b), 0.0) / k : 0.0;
    return std::min(a, b) - h * h * k * 0.25;
}
/// Intersection with a rounded edge of blend radius k.
inline double common(double a, double b, double k) {
    return -blend(-a, -b, k);
}
/// a without b, with a rounded edge of blend radius k.
inline double carve(double a, double b, double k) {
    return common(a, -b, k);
}

/// Smooth step from 0 at `from` to 1 at `to` (either order).
inline double ramp(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

inline double sphere(const Point& p, const Point& centre, double radius) {
    return glm::length(p - centre) - radius;
}

/// Half-space: inside where (p - on) . outward < 0; `outward` has unit length.
inline double halfSpace(const Point& p, const Point& on, const Point& outward) {
    return glm::dot(p - on, outward);
}

/// Distance to a box with half extents `half`, its edges rounded by `round` (outer size stays 2 half).
inline double box(const Point& p, const Point& centre, const Point& half, double round) {
    const Point q = glm::abs(p - centre) - half + round;
    return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0) - round;
}

/// Ring of major radius `ring` about the axis (centre, unit axis), tube radius `tube`.
inline double torus(const Point& p, const Point& centre, const Point& axis, double ring, double tube) {
    const Point q = p - centre;
    const double along = glm::dot(q, axis);
    return std::hypot(glm::length(q - along * axis) - ring, along) - tube;
}

/// Segment a-b thickened to a radius that runs from ra to rb.
inline double capsule(const Point& p, const Point& a, const Point& b, double ra, double rb) {
    const Point ab = b - a;
    const double t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
    return glm::length(p - a - t * ab) - (ra + t * (rb - ra));
}

/// Distance to an axis-aligned ellipsoid with semi-axes e about the origin, exact (a lower bound more than
/// `reach` outside, where a blend must not look): the closest point is e^2 p / (t + e^2), where t is the
/// largest root of sum (e p / (t + e^2))^2 = 1 (Newton from the left: the function is convex and falling
/// there, so no step overshoots).
double ellipsoid(const Point& p, const Point& e, double reach = 20);

/// Smooth deterministic noise in [-1, 1] with features of about one unit.
double noise(const Point& p);

/// `octaves` of noise, each half as large and half as high as the one before; in [-1, 1].
double layeredNoise(const Point& p, int octaves);

/// Distances to the nearest and the second nearest of points that are strewn over space, one in each unit
/// cube, at most `jitter` (0 to 1) of half a unit from its middle. `second - nearest` is 0 on the walls
/// between their cells. `which` tells the cells apart (0 to 1).
struct Cells {
    double nearest, second, which;
};
Cells cells(const Point& p, double jitter);

} // namespace serosa::models
