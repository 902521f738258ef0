// See render/surface_measures.h.
#include "render/surface_measures.h"

#include "render/triangle_basis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace serosa::render {

namespace {

constexpr int kDirections = 1440;
constexpr double kTurn = 2 * std::numbers::pi;

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

glm::dvec2 projected(const glm::dvec3& p, int axis) {
    return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

/// Pushes out the farthest point in every direction that the segment a, b crosses.
void reachOut(const glm::dvec2& a, const glm::dvec2& b, std::vector<double>& reach) {
    double from = std::atan2(a.y, a.x), to = std::atan2(b.y, b.x);
    if (to - from > kTurn / 2)
        from += kTurn;
    if (from - to > kTurn / 2)
        to += kTurn;
    const double low = std::min(from, to), high = std::max(from, to);
    for (int i = int(std::ceil(low / kTurn * kDirections)); i <= int(std::floor(high / kTurn * kDirections));
         ++i) {
        const double angle = i * kTurn / kDirections;
        const glm::dvec2 direction(std::cos(angle), std::sin(angle));
        const double along = cross2(direction, b - a);
        double r = std::max(glm::dot(direction, a), glm::dot(direction, b));
        if (std::abs(along) > 1e-12)
            r = cross2(a, b - a) / along;
        double& farthest = reach[std::size_t((i % kDirections + kDirections) % kDirections)];
        farthest = std::max(farthest, r);
    }
}

} // namespace

double silhouetteJaggedness(const std::vector<glm::dvec3>& positions, const std::vector<glm::uvec3>& faces,
                            int axis, double window) {
    glm::dvec2 lowest(std::numeric_limits<double>::max()), highest(-lowest);
    for (const glm::uvec3& face : faces)
        for (int i = 0; i < 3; ++i) {
            lowest = glm::min(lowest, projected(positions[face[i]], axis));
            highest = glm::max(highest, projected(positions[face[i]], axis));
        }
    const glm::dvec2 middle = 0.5 * (lowest + highest);
    std::vector<double> reach(kDirections, 0);
    for (const glm::uvec3& face : faces)
        for (int i = 0; i < 3; ++i)
            reachOut(projected(positions[face[i]], axis) - middle,
                     projected(positions[face[(i + 1) % 3]], axis) - middle, reach);
    double mean = 0;
    for (const double r : reach)
        mean += r / kDirections;
    const int half = std::max(1, int(0.5 * window / mean / kTurn * kDirections));
    double sum2 = 0;
    for (int i = 0; i < kDirections; ++i) {
        double around = 0;
        for (int j = -half; j <= half; ++j)
            around += reach[std::size_t((i + j + kDirections) % kDirections)] / (2 * half + 1);
        sum2 += (reach[std::size_t(i)] - around) * (reach[std::size_t(i)] - around) / kDirections;
    }
    return std::sqrt(sum2);
}

SurfaceDamage surfaceDamage(const std::vector<glm::dvec3>& mapped, const std::vector<glm::dvec3>& deformed,
                            const std::vector<glm::uvec3>& faces) {
    SurfaceDamage damage;
    for (const glm::uvec3& f : faces) {
        for (int i = 0; i < 3; ++i) {
            const double stretch = glm::distance(mapped[f[i]], mapped[f[(i + 1) % 3]]) /
                                   glm::distance(deformed[f[i]], deformed[f[(i + 1) % 3]]);
            if (!(stretch <= damage.largestStretch)) // NaN stays
                damage.largestStretch = stretch;
        }
        damage.flipped += !(glm::dot(triangleNormal(mapped[f.x], mapped[f.y], mapped[f.z]),
                                     triangleNormal(deformed[f.x], deformed[f.y], deformed[f.z])) > 0);
    }
    return damage;
}

AngleSpread anglesBetween(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    std::vector<double> angles;
    for (std::size_t i = 0; i < a.size(); ++i)
        angles.push_back(glm::degrees(std::atan2(glm::length(glm::cross(a[i], b[i])), glm::dot(a[i], b[i]))));
    return {quantile(angles, 0.5), quantile(angles, 1)};
}

double quantile(std::vector<double> values, double share) {
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); }))
        return std::numeric_limits<double>::quiet_NaN();
    const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

} // namespace serosa::render
