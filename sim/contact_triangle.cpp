// See sim/contact_triangle.h. The deepest point is found by projected gradients on the triangle itself: with
// c the distance to the core of a rounded shape, no curvature of phi is above 1/c, so that a step of length c
// never overshoots; for equal depths it goes to the core's nearest point and back to the triangle's, which
// for a sphere is the end of it.
#include "sim/contact_triangle.h"

#include "shaders/shared_constants.h"
#include "sim/shape_distance.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

glm::dvec3 weigh(const Corners& p, const glm::dvec3& weights) {
    return weights.x * p[0] + weights.y * p[1] + weights.z * p[2];
}

/// The vector in the triangle's plane along which the interpolated depth grows.
glm::dvec3 depthGradient(const Corners& p, const glm::dvec3& depth) {
    const glm::dvec3 e = p[1] - p[0], f = p[2] - p[0];
    const double ee = glm::dot(e, e), ef = glm::dot(e, f), ff = glm::dot(f, f), det = ee * ff - ef * ef;
    if (!(det > 1e-12 * ee * ff))
        return glm::dvec3(0);
    const double a = depth.y - depth.x, b = depth.z - depth.x;
    return ((a * ff - b * ef) * e + (b * ee - a * ef) * f) / det;
}

double longestEdge(const Corners& p) {
    return std::max({glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])});
}

} // namespace

TriangleGap deepestPoint(const RigidShape& shape, const Corners& p, const glm::dvec3& depth) {
    static const glm::dvec3 kStarts[] = {{1, 0, 0},     {0, 1, 0},     {0, 0, 1},          {0.5, 0.5, 0},
                                         {0, 0.5, 0.5}, {0.5, 0, 0.5}, glm::dvec3(1.0 / 3)};
    TriangleGap best;
    ShapeSample sample;
    bool first = true;
    for (const glm::dvec3& weights : kStarts) {
        const ShapeSample here = sampleShape(shape, weigh(p, weights));
        const double gap = here.distance - glm::dot(weights, depth);
        if (first || gap < best.gap) {
            best = {weights, gap};
            sample = here;
        }
        first = false;
    }
    const glm::dvec3 uphill = depthGradient(p, depth);
    const double least = 0.25 * longestEdge(p);
    glm::dvec3 at = weigh(p, best.weights);
    double stretch = 1;
    for (int i = 0; i < SRS_TRIANGLE_ITERATIONS; ++i) {
        const double step = stretch * std::max(std::abs(sample.distance + shape.radius), least);
        const TrianglePoint next =
            closestPointOnTriangle(at - step * (sample.normal - uphill), p[0], p[1], p[2]);
        const glm::dvec3 moved = next.point - at;
        if (glm::dot(moved, moved) < 1e-16)
            break;
        const ShapeSample here = sampleShape(shape, next.point);
        const double gap = here.distance - glm::dot(next.weights, depth);
        if (gap < best.gap) {
            best = {next.weights, gap};
            at = next.point;
            sample = here;
            stretch *= 2;
        } else {
            stretch *= 0.25;
        }
    }
    return best;
}

namespace {

Corners between(const Corners& y0, const Corners& y1, double s) {
    return {y0[0] + s * (y1[0] - y0[0]), y0[1] + s * (y1[1] - y0[1]), y0[2] + s * (y1[2] - y0[2])};
}

/// One distance says that no point of the triangle comes near on its way; kApart, as a field's slope may be a
/// little above 1.
bool surelyApart(const RigidShape& shape, const Corners& y1, const glm::dvec3& depth, double path) {
    constexpr double kApart = 0.1;
    const glm::dvec3 middle = (y1[0] + y1[1] + y1[2]) / 3.0;
    const double reach =
        std::max({glm::distance(middle, y1[0]), glm::distance(middle, y1[1]), glm::distance(middle, y1[2])});
    return shapeLowerBound(shape, middle) > reach + path + std::max({depth.x, depth.y, depth.z}) + kApart;
}

/// Does the shape lie on the inner side of the triangle, behind the point of it that is nearest to it?
bool fromInside(const RigidShape& shape, const Corners& y0, const glm::dvec3& depth) {
    const glm::dvec3 outward = glm::cross(y0[1] - y0[0], y0[2] - y0[0]);
    const glm::dvec3 n = sampleShape(shape, weigh(y0, deepestPoint(shape, y0, depth).weights)).normal;
    return glm::dot(n, outward) > 0.5 * glm::length(outward);
}

/// Where a triangle first touches, and how deep there; a gap >= 0: nowhere.
TriangleGap firstTouch(const RigidShape& shape, const Corners& y0, const Corners& y1, const glm::dvec3& depth,
                       double path, int samples) {
    TriangleGap deepest = deepestPoint(shape, y1, depth);
    for (int k = 0; k < samples && samples > 1 && deepest.gap >= 0;) {
        deepest = deepestPoint(shape, between(y0, y1, double(k) / samples), depth);
        k += std::max(1, int(std::min(deepest.gap * samples / path, double(samples)))); // apart until then
    }
    return deepest;
}

} // namespace

TriangleContact triangleContact(const ContactShape& collider, const Corners& y0, const Corners& y1,
                                const glm::dvec3& surface) {
    double path = 0;
    for (std::size_t i = 0; i < 3; ++i)
        path = std::max(path, glm::distance(y0[i], y1[i]));
    const int samples = sweepSamples(path, collider.thin);
    // Most triangles do not even touch as a wall.
    glm::dvec3 depth = glm::max(surface, glm::min(surface, glm::dvec3(0)) + double(SRS_WALL));
    if (surelyApart(collider.shape, y1, depth, path))
        return {};
    TriangleGap deepest = firstTouch(collider.shape, y0, y1, depth, path, samples);
    if (deepest.gap < 0 && !fromInside(collider.shape, y0, surface)) {
        const glm::dvec3 more = depth - surface;
        depth = surface;
        if (samples == 1 && more.x == more.y && more.y == more.z)
            deepest.gap += more.x; // the same point
        else
            deepest = firstTouch(collider.shape, y0, y1, depth, path, samples);
    }
    if (!(deepest.gap < 0))
        return {};
    return {deepest.weights, pointContact(collider, weigh(y0, deepest.weights), weigh(y1, deepest.weights),
                                          glm::dot(deepest.weights, depth), samples)};
}

} // namespace serosa::sim
