// The tree of boxes: built by splitting at the median centre along the longest axis, searched nearest box
// first. Ericson 2005 section 5.1.5 (closest point); Woop, Benthin & Wald 2013, Watertight ray/triangle
// intersection.
#include "sim/triangle_tree.h"

#include "base/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace serosa::sim {
namespace {

constexpr std::uint32_t kLeafSize = 4;
// Median splits halve 2^32 triangles at most 32 times; each level leaves at most one box behind.
constexpr std::size_t kStackSize = 72;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double distance2ToBox(const glm::dvec3& p, const glm::dvec3& lowest, const glm::dvec3& highest) {
    const glm::dvec3 outside = glm::max(glm::max(lowest - p, p - highest), glm::dvec3(0));
    return glm::dot(outside, outside);
}

bool before(const glm::dvec3& a, const glm::dvec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// The share of b in the point of the edge a, b closest to p; the same bits of the point from both sides of
/// the edge.
double shareOnEdge(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, glm::dvec3& point) {
    const glm::dvec3 edge = b - a;
    const double length2 = glm::dot(edge, edge);
    const double share = length2 > 0 ? std::clamp(glm::dot(p - a, edge) / length2, 0.0, 1.0) : 0.0;
    point = share == 1.0 ? b : a + share * edge;
    return share;
}

TrianglePoint onEdge(const glm::dvec3& p, const std::array<glm::dvec3, 3>& corners, int first, int second) {
    if (before(corners[second], corners[first]))
        std::swap(first, second);
    TrianglePoint result;
    const double share = shareOnEdge(p, corners[first], corners[second], result.point);
    result.weights = glm::dvec3(0);
    result.weights[first] = 1 - share;
    result.weights[second] = share;
    return result;
}

/// Zero area: the closest of the three edges.
TrianglePoint onEdges(const glm::dvec3& p, const std::array<glm::dvec3, 3>& corners) {
    TrianglePoint best;
    double bestDistance2 = kInfinity;
    for (int i = 0; i < 3; ++i) {
        const TrianglePoint candidate = onEdge(p, corners, i, (i + 1) % 3);
        const glm::dvec3 offset = p - candidate.point;
        if (glm::dot(offset, offset) < bestDistance2) {
            bestDistance2 = glm::dot(offset, offset);
            best = candidate;
        }
    }
    return best;
}

/// A ray made ready: the axis of its largest component last, and a shear that turns it into (0, 0, 1) (Woop
/// 2013).
struct ShearedRay {
    glm::dvec3 origin, direction;
    int x, y, z;
    double shearX, shearY, scaleZ;

    ShearedRay(const glm::dvec3& rayOrigin, const glm::dvec3& rayDirection)
        : origin(rayOrigin), direction(rayDirection) {
        const glm::dvec3 size = glm::abs(direction);
        z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        x = (z + 1) % 3;
        y = (z + 2) % 3;
        if (direction[z] < 0)
            std::swap(x, y); // keeps the winding
        shearX = direction[x] / direction[z];
        shearY = direction[y] / direction[z];
        scaleZ = 1 / direction[z];
    }

    /// False where the ray's line passes the triangle or lies in its plane. Edges and corners count for all
    /// their triangles.
    bool meets(const glm::dvec3& cornerA, const glm::dvec3& cornerB, const glm::dvec3& cornerC,
               TriangleTree::Hit& hit) const {
        const glm::dvec3 a = cornerA - origin, b = cornerB - origin, c = cornerC - origin;
        const double ax = a[x] - shearX * a[z], ay = a[y] - shearY * a[z];
        const double bx = b[x] - shearX * b[z], by = b[y] - shearY * b[z];
        const double cx = c[x] - shearX * c[z], cy = c[y] - shearY * c[z];
        const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0))
            return false;
        const double sum = u + v + w;
        if (sum == 0)
            return false;
        hit.weights = glm::dvec3(u, v, w) / sum;
        hit.t = scaleZ * glm::dot(hit.weights, glm::dvec3(a[z], b[z], c[z]));
        hit.front = glm::dot(glm::cross(cornerB - cornerA, cornerC - cornerA), direction) < 0;
        return true;
    }

    bool meetsBox(const glm::dvec3& lowest, const glm::dvec3& highest, double tMax) const {
        double enter = 0, leave = tMax;
        for (int axis = 0; axis < 3; ++axis) {
            if (direction[axis] == 0) {
                if (origin[axis] < lowest[axis] || origin[axis] > highest[axis])
                    return false;
                continue;
            }
            double near = (lowest[axis] - origin[axis]) / direction[axis];
            double far = (highest[axis] - origin[axis]) / direction[axis];
            if (near > far)
                std::swap(near, far);
            enter = std::max(enter, near);
            leave = std::min(leave, far);
        }
        // A few roundings of slack: a box too many costs a test, one too few loses a hit.
        return enter <= leave + 1e-14 * (std::abs(leave) + std::abs(enter));
    }
};

} // namespace

TrianglePoint closestPointOnTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                     const glm::dvec3& c) {
    const glm::dvec3 ab = b - a, ac = c - a;
    const glm::dvec3 ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0)
        return {a, {1, 0, 0}};

    const glm::dvec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3)
        return {b, {0, 1, 0}};

    const glm::dvec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6)
        return {c, {0, 0, 1}};

    // Unlike the book, any edge that p projects outside of sends a zero-area triangle to the test of all
    // three edges.
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    const std::array<glm::dvec3, 3> corners{a, b, c};
    if (!(va + vb + vc > 0))
        return onEdges(p, corners);
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return onEdge(p, corners, 0, 1);
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return onEdge(p, corners, 0, 2);
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return onEdge(p, corners, 1, 2);
    if (va < 0 || vb < 0 || vc < 0) // slivers, where the signs above lost to rounding
        return onEdges(p, corners);

    const double sum = va + vb + vc;
    const glm::dvec3 weights(va / sum, vb / sum, vc / sum);
    return {a + weights.y * ab + weights.z * ac, weights};
}

TriangleTree::TriangleTree(std::vector<glm::dvec3> positions, std::vector<glm::uvec3> triangles)
    : positions_(std::move(positions)), triangles_(std::move(triangles)) {
    SEROSA_CHECK(triangles_.size() < kNone, "too many triangles for 32-bit indices");
    for (const auto& triangle : triangles_)
        SEROSA_CHECK(std::max({triangle.x, triangle.y, triangle.z}) < positions_.size(),
                     "a corner out of range");
    if (!triangles_.empty())
        build();
}

void TriangleTree::build() {
    const auto count = static_cast<std::uint32_t>(triangles_.size());
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0u);
    std::vector<glm::dvec3> centres(count);
    double size = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::uvec3 t = triangles_[i];
        centres[i] = (positions_[t.x] + positions_[t.y] + positions_[t.z]) / 3.0;
        for (int corner = 0; corner < 3; ++corner)
            size = std::max({size, std::abs(positions_[t[corner]].x), std::abs(positions_[t[corner]].y),
                             std::abs(positions_[t[corner]].z)});
    }
    // Boxes are wider by more than the rounding of a closest point, so that no box hides an equally close
    // triangle.
    const glm::dvec3 pad(8 * std::numeric_limits<double>::epsilon() * size);

    nodes_.reserve(count);
    nodes_.push_back({});
    nodes_[0].count = count;
    for (std::size_t index = 0; index < nodes_.size(); ++index) {
        Node node = nodes_[index];
        glm::dvec3 lowestCentre(kInfinity), highestCentre(-kInfinity);
        node.lowest = glm::dvec3(kInfinity);
        node.highest = glm::dvec3(-kInfinity);
        const auto first = order_.begin() + node.begin, last = first + node.count;
        for (auto it = first; it != last; ++it) {
            lowestCentre = glm::min(lowestCentre, centres[*it]);
            highestCentre = glm::max(highestCentre, centres[*it]);
            for (int corner = 0; corner < 3; ++corner) {
                const glm::dvec3& p = positions_[triangles_[*it][corner]];
                node.lowest = glm::min(node.lowest, p);
                node.highest = glm::max(node.highest, p);
            }
        }
        node.lowest -= pad;
        node.highest += pad;
        if (node.count > kLeafSize) {
            const glm::dvec3 extent = highestCentre - lowestCentre;
            const int axis =
                extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
            const std::uint32_t half = node.count / 2;
            std::nth_element(first, first + half, last, [&](std::uint32_t i, std::uint32_t j) {
                return centres[i][axis] != centres[j][axis] ? centres[i][axis] < centres[j][axis] : i < j;
            });
            Node left, right;
            left.begin = node.begin;
            left.count = half;
            right.begin = node.begin + half;
            right.count = node.count - half;
            node.begin = static_cast<std::uint32_t>(nodes_.size());
            node.count = 0;
            nodes_.push_back(left);
            nodes_.push_back(right);
        }
        nodes_[index] = node;
    }
}

template <class Accept>
TriangleTree::Closest TriangleTree::search(const glm::dvec3& p, double limit2, const Accept& accept) const {
    Closest best;
    best.distance2 = limit2;
    if (nodes_.empty())
        return best;
    struct Pending {
        std::uint32_t node;
        double distance2;
    };
    std::array<Pending, kStackSize> stack;
    std::size_t depth = 0;
    stack[depth++] = {0, distance2ToBox(p, nodes_[0].lowest, nodes_[0].highest)};
    while (depth > 0) {
        const Pending pending = stack[--depth];
        if (pending.distance2 > best.distance2)
            continue;
        const Node& node = nodes_[pending.node];
        if (node.count == 0) {
            const std::uint32_t left = node.begin, right = node.begin + 1;
            Pending near{left, distance2ToBox(p, nodes_[left].lowest, nodes_[left].highest)};
            Pending far{right, distance2ToBox(p, nodes_[right].lowest, nodes_[right].highest)};
            if (far.distance2 < near.distance2)
                std::swap(near, far);
            if (far.distance2 <= best.distance2)
                stack[depth++] = far;
            if (near.distance2 <= best.distance2)
                stack[depth++] = near;
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.begin + node.count; ++i) {
            const std::uint32_t triangle = order_[i];
            const glm::uvec3 corners = triangles_[triangle];
            const TrianglePoint at = closestPointOnTriangle(p, positions_[corners.x], positions_[corners.y],
                                                            positions_[corners.z]);
            const glm::dvec3 offset = p - at.point;
            const double distance2 = glm::dot(offset, offset);
            // kNone is the highest index: with nothing found yet, a triangle exactly at the limit is taken.
            const bool closer =
                distance2 < best.distance2 || (distance2 == best.distance2 && triangle < best.triangle);
            if (closer && accept(triangle))
                best = {triangle, at.point, at.weights, distance2};
        }
    }
    return best;
}

TriangleTree::Closest TriangleTree::closest(const glm::dvec3& p) const {
    return search(p, kInfinity, [](std::uint32_t) { return true; });
}

TriangleTree::Closest TriangleTree::closest(const glm::dvec3& p, const Filter& filter) const {
    return closest(p, kInfinity, filter);
}

TriangleTree::Closest TriangleTree::closest(const glm::dvec3& p, double within, const Filter& filter) const {
    const double limit2 = within >= 0 ? within * within : -1;
    Closest best = filter ? search(p, limit2, filter) : search(p, limit2, [](std::uint32_t) { return true; });
    if (!best)
        best.distance2 = kInfinity;
    return best;
}

void TriangleTree::overlapping(const glm::dvec3& lowest, const glm::dvec3& highest,
                               const std::function<void(std::uint32_t)>& visit) const {
    if (nodes_.empty())
        return;
    const auto disjoint = [&](const glm::dvec3& low, const glm::dvec3& high) {
        return glm::any(glm::lessThan(high, lowest)) || glm::any(glm::greaterThan(low, highest));
    };
    std::array<std::uint32_t, kStackSize> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (disjoint(node.lowest, node.highest))
            continue;
        if (node.count == 0) {
            stack[depth++] = node.begin + 1;
            stack[depth++] = node.begin;
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.begin + node.count; ++i) {
            const glm::uvec3 t = triangles_[order_[i]];
            const glm::dvec3 &a = positions_[t.x], &b = positions_[t.y], &c = positions_[t.z];
            if (!disjoint(glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))))
                visit(order_[i]);
        }
    }
}

template <class Visit>
void TriangleTree::cast(const glm::dvec3& origin, const glm::dvec3& direction, double& tMax,
                        const Visit& visit) const {
    if (nodes_.empty() || direction == glm::dvec3(0))
        return;
    const ShearedRay ray(origin, direction);
    std::array<std::uint32_t, kStackSize> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const Node& node = nodes_[stack[--depth]];
        if (!ray.meetsBox(node.lowest, node.highest, tMax))
            continue;
        if (node.count == 0) {
            // The children's centres along the ray tell which comes first.
            const Node &left = nodes_[node.begin], &right = nodes_[node.begin + 1];
            const glm::dvec3 towards = right.lowest + right.highest - left.lowest - left.highest;
            const bool leftFirst = glm::dot(towards, direction) >= 0;
            stack[depth++] = leftFirst ? node.begin + 1 : node.begin;
            stack[depth++] = leftFirst ? node.begin : node.begin + 1;
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.begin + node.count; ++i) {
            const glm::uvec3 t = triangles_[order_[i]];
            Hit hit;
            hit.triangle = order_[i];
            if (ray.meets(positions_[t.x], positions_[t.y], positions_[t.z], hit) && hit.t >= 0 &&
                hit.t <= tMax)
                visit(hit);
        }
    }
}

std::optional<TriangleTree::Hit> TriangleTree::firstHit(const glm::dvec3& origin, const glm::dvec3& direction,
                                                        double tMax) const {
    std::optional<Hit> first;
    cast(origin, direction, tMax, [&](const Hit& hit) {
        if (!first || hit.t < first->t || (hit.t == first->t && hit.triangle < first->triangle)) {
            first = hit;
            tMax = hit.t;
        }
    });
    return first;
}

void TriangleTree::allHits(const glm::dvec3& origin, const glm::dvec3& direction, double tMax,
                           const std::function<void(const Hit&)>& visit) const {
    cast(origin, direction, tMax, [&](const Hit& hit) { visit(hit); });
}

} // namespace serosa::sim
