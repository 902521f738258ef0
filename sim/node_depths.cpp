// See sim/node_depths.h.
#include "sim/node_depths.h"

#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kStepsASpacing = 85, kOutermost = -2, kInnermost = 1;

} // namespace

bool isInside(const TriangleTree& tree, const glm::dvec3& p, double reach) {
    // Along no axis and no diagonal of the grid, so that it seldom meets an edge.
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.8713, 0.3391, 0.3549)) * reach;
    int winding = 0;
    tree.allHits(p, direction, 1, [&](const TriangleTree::Hit& hit) { winding += hit.front ? -1 : 1; });
    return winding > 0;
}

std::uint8_t depthStep(double depth) {
    return std::uint8_t(
        std::lround((std::clamp(depth, kOutermost, kInnermost) - kOutermost) * kStepsASpacing));
}

std::vector<std::uint8_t> surfaceDepths(const Lattice& lattice, const TriangleMesh& metres) {
    const TriangleTree tree(metres.positions, metres.faces);
    const double h = lattice.spacing, reach = 2 * glm::length(metres.highest() - metres.lowest()) + 4 * h;
    std::vector<std::uint8_t> steps(lattice.nodeCount(), depthStep(kInnermost));
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        if (lattice.massShare(node) >= 1)
            continue; // the cells around it are full: a spacing deep along each axis
        const glm::dvec3 p = lattice.toWorld(lattice.restPosition(node));
        const auto closest = tree.closest(p, -kOutermost * h);
        const double distance = closest ? std::sqrt(closest.distance2) / h : -kOutermost;
        steps[node] = depthStep(isInside(tree, p, reach) ? distance : -distance);
    }
    return steps;
}

std::vector<std::uint8_t> massDepths(const Lattice& lattice) {
    std::vector<std::uint8_t> steps;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        steps.push_back(depthStep(2 * lattice.massShare(node) - 1));
    return steps;
}

} // namespace serosa::sim
