// The predicate of sim/blade.h: twin of shaders/blade.glsl, operation by operation. Separating planes between
// a segment and the hull of a strip's four corners; the list of normals is complete also where strip and
// segment lie in one plane, on one line or in one point.
#include "sim/blade.h"

#include "base/check.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

using glm::dvec3;

// Plain products and sums in a fixed order: a library's dot may be fused or ordered otherwise.
double dot3(const dvec3& a, const dvec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
dvec3 cross3(const dvec3& a, const dvec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double largest3(const dvec3& a) {
    return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

/// A strip of the patch, seen from the segment's lower end: the segment goes from 0 to `d`.
struct Strip {
    dvec3 d;
    dvec3 x[4];   // corners in ring order
    double reach; // largest coordinate of all

    /// Is there a plane with this normal between the two, farther from both than rounding?
    bool separatedBy(const dvec3& n) const {
        const double end = dot3(n, d), low = std::min(0.0, end), high = std::max(0.0, end);
        double lowest = dot3(n, x[0]), highest = lowest;
        for (int i = 1; i < 4; ++i) {
            const double at = dot3(n, x[i]);
            lowest = std::min(lowest, at);
            highest = std::max(highest, at);
        }
        const double margin = SRS_BLADE_ROUNDING * reach * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
        return lowest - high > margin || low - highest > margin;
    }

    bool separated() const {
        if (separatedBy({1, 0, 0}) || separatedBy({0, 1, 0}) || separatedBy({0, 0, 1}) || separatedBy(d))
            return true;
        const dvec3 edges[6] = {x[1] - x[0], x[2] - x[1], x[3] - x[2], x[0] - x[3], x[2] - x[0], x[3] - x[1]};
        const dvec3 n = cross3(edges[4], edges[5]);
        if (separatedBy(n) || separatedBy(cross3(edges[0], edges[4])) ||
            separatedBy(cross3(edges[4], edges[3])) || separatedBy(cross3(edges[0], edges[5])) ||
            separatedBy(cross3(edges[1], edges[5])))
            return true;
        for (const dvec3& edge : edges) {
            const dvec3 c = cross3(d, edge);
            // Of a flat strip: in its plane. Of one that is a line: in the plane that it spans with the
            // segment.
            if (separatedBy(c) || separatedBy(cross3(n, edge)) || separatedBy(cross3(c, edge)) ||
                separatedBy(cross3(c, d)))
                return true;
        }
        return separatedBy(cross3(n, d)) || separatedBy(cross3(cross3(d, x[0]), d));
    }
};

bool bladeCuts(const std::array<glm::vec3, 4>& corners, const dvec3& p, const dvec3& q) {
    const dvec3 a0 = dvec3(corners[0]) - p, b0 = dvec3(corners[1]) - p;
    const dvec3 a = (dvec3(corners[2]) - p) - a0, b = (dvec3(corners[3]) - p) - b0; // sweeps of the two ends
    Strip strip{q - p, {}, 0};
    strip.reach =
        std::max({largest3(strip.d), largest3(a0), largest3(b0), largest3(a0 + a), largest3(b0 + b)});
    const double twist = largest3(b - a);
    // Strip number `index` of 2^depth, depth first: each is `width` = 2^-depth of the sweep.
    unsigned index = 0;
    int depth = 0;
    double width = 1;
    for (int test = 0; test < SRS_BLADE_MOST_TESTS; ++test) {
        const double v0 = double(index) * width, v1 = double(index + 1) * width;
        strip.x[0] = a0 + v0 * a;
        strip.x[1] = b0 + v0 * b;
        strip.x[2] = b0 + v1 * b;
        strip.x[3] = a0 + v1 * a;
        if (strip.separated()) {
            ++index;
            for (; depth > 0 && (index & 1u) == 0; --depth, width *= 2)
                index >>= 1;
            if (depth == 0)
                return false;
        } else if (twist * width <= SRS_BLADE_FLAT) {
            return true;
        } else {
            index <<= 1;
            ++depth;
            width *= 0.5;
        }
    }
    return true;
}

bool ballCuts(const dvec3& centre, double radius, const dvec3& p, const dvec3& q) {
    const dvec3 d = q - p, c = centre - p, e = centre - q;
    const double along = dot3(c, d), length2 = dot3(d, d), radius2 = radius * radius;
    if (along <= 0)
        return dot3(c, c) <= radius2;
    if (along >= length2)
        return dot3(e, e) <= radius2;
    return dot3(c, c) * length2 - along * along <= radius2 * length2;
}

} // namespace

LatticeStroke toLattice(const Stroke& stroke, const Lattice& lattice) {
    LatticeStroke result;
    result.kind = stroke.kind;
    for (std::size_t i = 0; i < 2; ++i) {
        result.corners[i] = glm::vec3(lattice.toLattice(stroke.from[i]));
        result.corners[2 + i] = glm::vec3(lattice.toLattice(stroke.to[i]));
    }
    result.size = stroke.kind == StrokeKind::cauterize ? float(stroke.radius / lattice.spacing)
                                                       : float((1 + stroke.strain) * (1 + stroke.strain));
    return result;
}

bool strokeCuts(const LatticeStroke& stroke, const glm::vec3& lower, const glm::vec3& higher, int rest2) {
    const dvec3 p(lower), q(higher);
    switch (stroke.kind) {
    case StrokeKind::blade:
        return bladeCuts(stroke.corners, p, q);
    case StrokeKind::cauterize:
        return ballCuts(dvec3(stroke.corners[0]), double(stroke.size), p, q);
    case StrokeKind::tear: {
        const dvec3 d = q - p;
        return dot3(d, d) > double(stroke.size) * double(rest2);
    }
    }
    return false;
}

bool leadsToHigherIndex(int d) {
    const glm::ivec3 offset = kNeighbourOffsets[std::size_t(d)]; // nodes are sorted z, y, x
    return offset.z != 0 ? offset.z > 0 : offset.y != 0 ? offset.y > 0 : offset.x > 0;
}

std::vector<std::uint32_t> cutConnections(const Lattice& lattice, const std::vector<glm::dvec3>& positions,
                                          const LatticeStroke& stroke,
                                          std::vector<std::uint32_t>& connections) {
    SEROSA_CHECK(positions.size() == lattice.nodeCount() && connections.size() == lattice.nodeCount(),
                 "one position and one word of connections a node");
    std::vector<std::uint32_t> cleared(lattice.nodeCount(), 0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
            if (!((connections[node] >> d) & 1u) || !leadsToHigherIndex(d))
                continue;
            const std::size_t other =
                std::size_t(lattice.nodeAt(lattice.nodes[node] + kNeighbourOffsets[std::size_t(d)]));
            if (!strokeCuts(stroke, glm::vec3(positions[node]), glm::vec3(positions[other]), d < 6 ? 1 : 2))
                continue;
            cleared[node] |= 1u << d;
            cleared[other] |= 1u << (d ^ 1);
        }
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        connections[node] &= ~cleared[node];
    return cleared;
}

} // namespace serosa::sim
