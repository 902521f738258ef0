// See sim/contact_point.h.
#include "sim/contact_point.h"

#include "shaders/shared_constants.h"
#include "sim/shape_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::sim {

namespace {

/// Least t >= 0 with phi(p + t n) >= target (rounding apart): Newton's steps, which on a convex shape pass
/// the root once and come back to it from outside, within a bracket. Where n leads inward first, steps by the
/// gap that is missing, which none can pass.
double distanceOut(const RigidShape& shape, const glm::dvec3& p, const glm::dvec3& n, double target) {
    double t = 0, low = 0, high = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 40; ++i) {
        const ShapeSample sample = sampleShape(shape, p + t * n);
        const double gap = sample.distance - target, slope = glm::dot(sample.normal, n);
        if (i == 0 && gap >= 0)
            return 0;
        if (std::abs(gap) < 1e-12)
            return t;
        (gap < 0 ? low : high) = t;
        double next = slope > 0.01 ? t - gap / slope : t + std::abs(gap);
        if (!(next > low && next < high))
            next = high < std::numeric_limits<double>::infinity() ? 0.5 * (low + high) : t + std::abs(gap);
        if (!(next > low && next < high)) // the bracket is one rounding wide
            break;
        t = next;
    }
    return high < std::numeric_limits<double>::infinity() ? high : t;
}

/// Where and how a point first touches.
struct Touch {
    bool any = false;
    bool through = false; // ends outside: it would go through
    glm::dvec3 at{0}, normal{0, 1, 0};
    double gap = 0;    // there
    double target = 0; // least gap at the step's end
};

Touch findTouch(const RigidShape& shape, const glm::dvec3& y0, const glm::dvec3& y1, double depth,
                int samples) {
    Touch touch;
    const auto at = [&](double s) { return s == 1 ? y1 : y0 + s * (y1 - y0); };
    const auto gapAt = [&](double s) { return shapeDistance(shape, at(s)) - depth; };
    const ShapeSample start = sampleShape(shape, y0);
    const double gap0 = start.distance - depth;
    if (gap0 < 0) {
        touch.at = y0;
        touch.normal = start.normal;
        touch.gap = gap0;
        touch.target = std::min(0.0, gap0 + SRS_EJECTION);
        touch.any = gapAt(1) < touch.target;
        for (int k = 1; k < samples && !touch.any; ++k)
            touch.any = touch.through = gapAt(double(k) / samples) < gap0;
        return touch;
    }
    double outside = 0, inside = 0;
    for (int k = 1; k <= samples && !touch.any; ++k) {
        inside = double(k) / samples;
        touch.any = gapAt(inside) < 0;
        if (!touch.any)
            outside = inside;
    }
    if (!touch.any)
        return touch;
    touch.through = inside < 1 && gapAt(1) >= 0;
    for (int i = 0; i < SRS_SWEEP_BISECTIONS; ++i) {
        const double middle = 0.5 * (outside + inside);
        (gapAt(middle) < 0 ? inside : outside) = middle;
    }
    touch.at = at(outside);
    const ShapeSample sample = sampleShape(shape, touch.at);
    touch.normal = sample.normal;
    touch.gap = sample.distance - depth;
    return touch;
}

} // namespace

double contactDepthFor(double depth, double thin) {
    return std::max(depth, -0.5 * thin);
}

int sweepSamples(double path, double thin) {
    const double samples = std::ceil(path / (0.5 * thin)); // 0 for a half-space
    return samples < SRS_SWEEP_SAMPLES ? std::max(int(samples), 1) : SRS_SWEEP_SAMPLES;
}

glm::dvec3 pointContact(const ContactShape& collider, const glm::dvec3& y0, const glm::dvec3& y1,
                        double depth, int samples) {
    const Touch touch = findTouch(collider.shape, y0, y1, depth, samples);
    if (!touch.any)
        return glm::dvec3(0);
    const glm::dvec3& n = touch.normal;
    const double ejected = touch.gap < 0 ? touch.target - touch.gap : 0;
    const auto outBy = [&](const glm::dvec3& from) {
        return touch.through ? std::max(glm::dot(n, touch.at - from) + ejected, 0.0)
                             : distanceOut(collider.shape, from, n, touch.target + depth);
    };
    const double out = outBy(y1);
    if (!(collider.friction > 0))
        return n * out;
    const glm::dvec3 motion = y1 - y0, along = motion - n * glm::dot(n, motion);
    const double slide = glm::length(along),
                 held = std::min(slide, collider.friction * std::max(0.0, out - ejected));
    if (!(held > 0))
        return n * out;
    const glm::dvec3 back = along * (held / slide);
    return n * outBy(y1 - back) - back;
}

} // namespace serosa::sim
