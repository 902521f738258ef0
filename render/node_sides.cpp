// See render/node_sides.h.
#include "render/node_sides.h"

#include "shaders/shared_constants.h"

#include <cmath>

namespace serosa::render {

namespace {
// Spacings from a cut: the corners of a cell that it goes through are nearer than the first; beyond
// SRS_MASK_SIDES it is not known.
constexpr double kAllNear = 1.75, kNoneNear = 2.9;
} // namespace

bool NodeSides::isFar(std::size_t node) const {
    return std::abs(sides_[node]) >= float(SRS_MASK_FAR);
}

bool NodeSides::isOn(std::size_t node, int side) const {
    return !isFar(node) && (sides_[node] >= 0) == (side > 0);
}

int NodeSides::parting(const glm::dvec3& place) const {
    int found = 0;
    const auto look = [&](std::int64_t node) {
        if (node < 0)
            return;
        const auto i = std::size_t(node);
        if (connections_[i] != lattice_.connections[i])
            found |= kLost;
        if (std::abs(sides_[i]) < float(SRS_MASK_REACH))
            found |= sides_[i] < 0 ? kBelow : kAbove;
    };
    const glm::ivec3 cell = glm::ivec3(glm::floor(place)) + lattice_.centre;
    for (int c = 0; c < 8; ++c)
        look(lattice_.nodeAt(cell + sim::cornerOffset(c)));
    return found;
}

double NodeSides::away(const glm::dvec3& place, const VertexBinding& bound) const {
    const glm::dvec3 low = glm::floor(place), at = place - low;
    double sum = 0, weights = 0;
    const auto add = [&](std::int64_t node, double weight) {
        if (node < 0 || isFar(std::size_t(node)))
            return;
        sum += weight * sides_[std::size_t(node)];
        weights += weight;
    };
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 offset = sim::cornerOffset(c);
        const glm::dvec3 w = glm::mix(1.0 - at, at, glm::dvec3(offset));
        add(lattice_.nodeAt(glm::ivec3(low) + lattice_.centre + offset), w.x * w.y * w.z);
    }
    for (int i = 0; i < 3 && weights < 0.5; ++i)
        add(bound.nodes[i], bound.weights[i]);
    return weights > 0.1 ? sum / weights : 0;
}

float NodeSides::nearness(const glm::dvec3& place) const {
    const glm::dvec3 low = glm::floor(place), at = place - low;
    double sum = 0, weights = 0;
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 offset = sim::cornerOffset(c);
        const std::int64_t node = lattice_.nodeAt(glm::ivec3(low) + lattice_.centre + offset);
        if (node < 0)
            continue;
        const glm::dvec3 w = glm::mix(1.0 - at, at, glm::dvec3(offset));
        const double weight = w.x * w.y * w.z;
        sum +=
            weight * (1 - glm::smoothstep(kAllNear, kNoneNear, std::abs(double(sides_[std::size_t(node)]))));
        weights += weight;
    }
    return weights > 0 ? float(sum / weights) : 0;
}

bool NodeSides::anyOn(const glm::uvec3& nodes, int side) const {
    return isOn(nodes.x, side) || isOn(nodes.y, side) || isOn(nodes.z, side);
}

} // namespace serosa::render
