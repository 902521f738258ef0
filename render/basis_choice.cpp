// MS05 3.5 and 3.6. See render/basis_choice.h.
#include "render/basis_choice.h"

#include "render/triangle_basis.h"
#include "sim/packed_normal.h"

#include <algorithm>

namespace serosa::render {

namespace {

constexpr double kShortestSum = 0.5;   // of eq. 3 at a node: one-node-thin sheets
constexpr double kShortestMean = 0.35; // of eq. 8's N_c: nodes whose normals oppose
constexpr double kSmallestSine = 0.3;  // between N_c and the first edge

constexpr double kFlatSum = 3.8; // eq. 3's sum on a flat face

// The hand-over of `chosen`: from none to all of the corrected basis.
constexpr glm::dvec2 kSum(0.5, 1.5);      // length of eq. 3's sum
constexpr glm::dvec2 kTrust(0.25, 0.75);  // of the nodes, weighted
constexpr glm::dvec2 kMean(0.2, 0.45);    // length of N_c
constexpr glm::dvec2 kSine(0.3, 0.5);     // between N_c and the first edge
constexpr glm::dvec2 kFacing(0.1, 0.4);   // N_c . N
constexpr glm::dvec2 kOffset(0.03, 0.08); // spacings: length of the offset

double over(const glm::dvec2& range, double value) {
    return glm::smoothstep(range.x, range.y, value);
}

} // namespace

RestNormals::RestNormals(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections)
    : RestNormals(controlNodes(lattice, connections)) {
    for (std::size_t node = 0; node < connections.size(); ++node)
        cut_.push_back(connections[node] != lattice.connections[node]);
}

RestNormals::RestNormals(const ControlNodes& nodes) {
    std::vector<double> areas(nodes.count());
    for (const glm::uvec3& t : nodes.triangles)
        for (int i = 0; i < 3; ++i)
            areas[t[i]] += glm::length(triangleNormal(nodes.rest[t.x], nodes.rest[t.y], nodes.rest[t.z]));
    const std::vector<glm::dvec3> sums = normalSums(nodes, nodes.rest);
    for (std::size_t node = 0; node < nodes.count(); ++node) {
        normals_.emplace_back(sim::unpackNormal(sim::packNormal(glm::vec3(sums[node]))));
        const double length = glm::length(sums[node]);
        lengths_.push_back(nodes.normalsOfTriangles ? kFlatSum * length / std::max(areas[node], 1e-30)
                                                    : length);
    }
}

double RestNormals::trust(std::uint32_t node) const {
    return isCut(node) ? 0 : over(kSum, lengths_[node]);
}

bool correctedIsDefined(const RestNormals& rest, const BoundPoint& point) {
    for (int i = 0; i < 3; ++i)
        if (rest.isCut(point.nodes[i]) || rest.length(point.nodes[i]) < kShortestSum)
            return false;
    const glm::dvec3 mean = point.mean(rest), edge = point.corners[1] - point.corners[0];
    return glm::length(mean) >= kShortestMean &&
           glm::length(glm::cross(mean, edge)) >= kSmallestSine * glm::length(mean) * glm::length(edge);
}

double correctedShare(const RestNormals& rest, const BoundPoint& point) {
    const glm::dvec3 mean = point.mean(rest), edge = point.corners[1] - point.corners[0];
    const double length = glm::length(mean);
    if (length < kMean.x)
        return 0;
    const glm::dvec3 flat =
        glm::normalize(triangleNormal(point.corners[0], point.corners[1], point.corners[2]));
    return over(kTrust, glm::dot(point.weights, point.counts)) * over(kMean, length) *
           over(kSine, glm::length(glm::cross(mean, edge)) / (length * glm::length(edge))) *
           over(kFacing, glm::dot(mean, flat) / length) *
           over(kOffset, glm::distance(point.vertex, point.reference()));
}

} // namespace serosa::render
