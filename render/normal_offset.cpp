// MS05 3.5. See render/normal_offset.h.
#include "render/normal_offset.h"

#include "render/triangle_basis.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace serosa::render {

namespace {

constexpr double kReach = 2.0;   // spacings to either side of the triangle
constexpr int kPieces = 64;      // of that, in which a change of sign is looked for
constexpr int kHalvings = 50;    // to the last bits of a double
constexpr double kBeside = 0.25; // least weight is -this: how far r may lie beside the triangle

/// Weights of p in the plane of a, b, c.
glm::dvec3 weightsIn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double scale = 1 / glm::dot(n, n);
    const double w1 = scale * glm::dot(n, glm::cross(b - p, c - p)),
                 w2 = scale * glm::dot(n, glm::cross(c - p, a - p));
    return {w1, w2, 1 - w1 - w2};
}

glm::vec3 rounded(const glm::dvec3& weights) {
    const glm::vec2 w(weights);
    return {w.x, w.y, float(1 - double(w.x) - double(w.y))};
}

struct Root {
    double distance; // d'
    glm::dvec3 weights;
};

/// The root that is nearest to the triangle.
std::optional<Root> along(const RestNormals& rest, const BoundPoint& point) {
    glm::dvec3 corner[3];
    const auto lift = [&](double d) {
        for (int i = 0; i < 3; ++i)
            corner[i] = point.corners[i] + d * rest.normal(point.nodes[i]);
        const glm::dvec3 n = triangleNormal(corner[0], corner[1], corner[2]);
        return glm::dot(n, point.vertex - corner[0]);
    };
    std::optional<Root> best;
    double below = lift(-kReach);
    for (int piece = 0; piece < kPieces; ++piece) {
        double low = kReach * (2.0 * piece / kPieces - 1), high = kReach * (2.0 * (piece + 1) / kPieces - 1);
        const double above = lift(high);
        if ((below < 0) != (above < 0)) {
            for (int i = 0; i < kHalvings; ++i) {
                const double middle = 0.5 * (low + high);
                ((lift(middle) < 0) == (below < 0) ? low : high) = middle;
            }
            lift(low);
            const glm::dvec3 weights = weightsIn(corner[0], corner[1], corner[2], point.vertex);
            const bool beside = !(std::min({weights.x, weights.y, weights.z}) >= -kBeside);
            if (!beside && (!best || std::abs(low) < std::abs(best->distance)))
                best = Root{low, weights};
        }
        below = above;
    }
    return best;
}

} // namespace

NormalOffset offsetAlongNormal(const RestNormals& rest, const BoundPoint& point) {
    if (const auto root = along(rest, point)) {
        BoundPoint at = point;
        at.weights = root->weights;
        if (correctedIsDefined(rest, at)) // the shader normalizes N_c
            return {rounded(root->weights), float(root->distance * glm::length(at.mean(rest))), true};
    }
    const glm::dvec3 &p1 = point.corners[0], &p2 = point.corners[1], &p3 = point.corners[2];
    const glm::dvec3 n = glm::normalize(triangleNormal(p1, p2, p3));
    const double distance = glm::dot(n, point.vertex - p1);
    return {rounded(weightsIn(p1, p2, p3, point.vertex - distance * n)), float(distance), false};
}

} // namespace serosa::render
