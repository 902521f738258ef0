// See sim/node_depths.h.
#include "sim/node_depths.h"

#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kStepsASpacing = 85, kOutermost = -2;
constexpr double kHeld = 0.6, kInnermost = 1, kDeep = kHeld + 2 * (kInnermost - kHeld); // contactDepth

} // namespace

bool isInside(const TriangleTree& tree, const glm::dvec3& p, double reach) {
    // Along no axis and no diagonal of the grid, so that it seldom meets an edge.
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.8713, 0.3391, 0.3549)) * reach;
    int winding = 0;
    tree.allHits(p, direction, 1, [&](const TriangleTree::Hit& hit) { winding += hit.front ? -1 : 1; });
    return winding > 0;
}

double contactDepth(double depth) {
    return std::min(depth <= kHeld ? depth : kHeld + 0.5 * (depth - kHeld), kInnermost);
}

double depthOfContact(double counted) {
    return counted <= kHeld ? counted : kHeld + 2 * (counted - kHeld);
}

std::uint8_t depthStep(double depth) {
    return std::uint8_t(
        std::lround((std::max(contactDepth(depth), kOutermost) - kOutermost) * kStepsASpacing));
}

std::vector<std::uint8_t> surfaceDepths(const Lattice& lattice, const TriangleMesh& metres) {
    const TriangleTree tree(metres.positions, metres.faces);
    const double h = lattice.spacing, reach = 2 * glm::length(metres.highest() - metres.lowest()) + 4 * h;
    std::vector<std::uint8_t> steps(lattice.nodeCount(), depthStep(kDeep));
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const bool full = lattice.massShare(node) >= 1; // the cells around it are: it lies inside
        const double limit = full ? kDeep : -kOutermost;
        const glm::dvec3 p = lattice.toWorld(lattice.restPosition(node));
        const auto closest = tree.closest(p, limit * h);
        const double distance = closest ? std::sqrt(closest.distance2) / h : limit;
        steps[node] = depthStep(full || isInside(tree, p, reach) ? distance : -distance);
    }
    return steps;
}

std::vector<std::uint8_t> massDepths(const Lattice& lattice) {
    std::vector<std::uint8_t> steps;
    const auto full = [&](std::size_t node) { return lattice.massShare(node) >= 1; };
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        bool deep = full(node);
        for (int d = 0; d < 18 && deep; ++d)
            deep = full(std::size_t(lattice.neighbour(node, d))); // a full node has all 18
        steps.push_back(depthStep(deep ? kDeep : 2 * lattice.massShare(node) - 1));
    }
    return steps;
}

} // namespace serosa::sim
