#pragma once
// A tree of axis-aligned boxes over triangles, in float64: closest points, ray casts and box overlaps.
// Closest point on a triangle: Ericson 2005, Real-Time Collision Detection, section 5.1.5; ray against
// triangle: Woop, Benthin & Wald 2013. The tree is built once, top-down, by the median of the longest axis of
// the triangles' centres.
//
// Deterministic: of several triangles at the same distance (or hit at the same t) the lowest index wins,
// whatever the shape of the tree. All const functions may be called from several threads at once.

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace serosa::sim {

/// A point of a triangle a, b, c: point = weights.x * a + weights.y * b + weights.z * c, with weights >= 0
/// and sum 1.
struct TrianglePoint {
    glm::dvec3 point{0};
    glm::dvec3 weights{1, 0, 0};
};

/// The point of the triangle a, b, c (zero-area ones too) that is closest to p.
TrianglePoint closestPointOnTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                     const glm::dvec3& c);

class TriangleTree {
public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    /// True for the triangles that a query may return.
    using Filter = std::function<bool(std::uint32_t triangle)>;

    struct Closest {
        std::uint32_t triangle = kNone; // kNone where the tree is empty or the filter let none pass
        glm::dvec3 point{0};            // in the unit of the positions
        glm::dvec3 weights{0};          // of the triangle's three corners, in its order; >= 0, sum 1
        double distance2 = 0;           // squared; infinity with kNone
        explicit operator bool() const { return triangle != kNone; }
    };

    struct Hit {
        std::uint32_t triangle = kNone;
        double t = 0;          // origin + t * direction, 0 <= t <= tMax
        glm::dvec3 weights{0}; // of the triangle's three corners
        bool front = false;    // the ray came against the winding's normal (from outside)
    };

    TriangleTree() = default;

    /// Keeps both arrays. Finite positions, indices in range (a broken promise otherwise); triangles may be
    /// degenerate.
    TriangleTree(std::vector<glm::dvec3> positions, std::vector<glm::uvec3> triangles);

    const std::vector<glm::dvec3>& positions() const { return positions_; }
    const std::vector<glm::uvec3>& triangles() const { return triangles_; }

    /// The triangle closest to p, and where on it.
    Closest closest(const glm::dvec3& p) const;
    /// The same among the triangles that `filter` lets pass. It is called once a candidate, in no promised
    /// order.
    Closest closest(const glm::dvec3& p, const Filter& filter) const;
    /// The same, and no further than `within` (in the unit of the positions): faster where far ones do not
    /// matter.
    Closest closest(const glm::dvec3& p, double within, const Filter& filter = {}) const;

    /// Calls `visit` for every triangle whose own bounding box overlaps [lowest, highest] (touching counts),
    /// in no promised order. A triangle's box may overlap where the triangle itself does not.
    void overlapping(const glm::dvec3& lowest, const glm::dvec3& highest,
                     const std::function<void(std::uint32_t triangle)>& visit) const;

    /// The first triangle that the segment origin + t * direction, 0 <= t <= tMax, meets, from either side.
    /// `direction` need not be of unit length; tMax = 1 makes it the segment from origin to origin +
    /// direction.
    std::optional<Hit> firstHit(const glm::dvec3& origin, const glm::dvec3& direction, double tMax) const;

    /// Calls `visit` for every triangle that the segment meets, in no promised order.
    void allHits(const glm::dvec3& origin, const glm::dvec3& direction, double tMax,
                 const std::function<void(const Hit&)>& visit) const;

private:
    struct Node {
        glm::dvec3 lowest, highest;
        std::uint32_t begin =
            0; // leaf: first entry of order_; inner: index of the left child (right = left + 1)
        std::uint32_t count = 0; // leaf: number of triangles; inner: 0
    };

    void build();
    template <class Accept>
    Closest search(const glm::dvec3& p, double limit2, const Accept& accept) const;
    template <class Visit>
    void cast(const glm::dvec3& origin, const glm::dvec3& direction, double& tMax, const Visit& visit) const;

    std::vector<glm::dvec3> positions_;
    std::vector<glm::uvec3> triangles_;
    std::vector<std::uint32_t> order_; // triangle indices, leaf by leaf
    std::vector<Node> nodes_;          // nodes_[0] is the root
};

} // namespace serosa::sim
