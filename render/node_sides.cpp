// See render/node_sides.h.
#include "render/node_sides.h"

#include "shaders/shared_constants.h"

#include <cmath>

namespace serosa::render {

bool NodeSides::isFar(std::size_t node) const {
    return std::abs(sides_[node]) >= float(SRS_MASK_FAR);
}

bool NodeSides::isOn(std::size_t node, int side) const {
    return !isFar(node) && (sides_[node] >= 0) == (side > 0);
}

int NodeSides::parting(const glm::dvec3& place, const glm::uvec3* nodes) const {
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
    for (int i = 0; i < 3 && nodes; ++i)
        look((*nodes)[i]);
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

bool NodeSides::areOn(const glm::uvec3& nodes, int side) const {
    for (int i = 0; i < 3; ++i)
        if (isLoose(nodes[i]) || !isOn(nodes[i], side))
            return false;
    return true;
}

bool NodeSides::goWith(const glm::uvec3& nodes, int side) const {
    for (int i = 0; i < 3; ++i)
        if (isLoose(nodes[i]) || isOn(nodes[i], -side))
            return false;
    return true;
}

bool NodeSides::havePlaces(const glm::uvec3& nodes, int side) const {
    return hasPlace(nodes.x, side) && hasPlace(nodes.y, side) && hasPlace(nodes.z, side);
}

bool NodeSides::touches(std::size_t node, int side) const {
    for (int d = 0; d < 18; ++d)
        if ((lattice_.connections[node] >> d) & 1U && isOn(std::size_t(lattice_.neighbour(node, d)), side))
            return true;
    return false;
}

bool NodeSides::hasPlace(std::size_t node, int side) const {
    if (!isLoose(node) && !isOn(node, -side))
        return true;
    bool joined = isLoose(node) || touches(node, side);
    for (int d = 0; d < 6 && !joined; ++d)
        if (const std::int64_t other = lattice_.neighbour(node, d);
            other >= 0 && isOn(std::size_t(other), -side))
            joined = touches(std::size_t(other), side);
    const glm::ivec3 at = lattice_.nodes[node];
    for (int z = -SRS_SIDE_REACH; z <= SRS_SIDE_REACH && joined; ++z)
        for (int y = -SRS_SIDE_REACH; y <= SRS_SIDE_REACH; ++y)
            for (int x = -SRS_SIDE_REACH; x <= SRS_SIDE_REACH; ++x) {
                const std::int64_t other = lattice_.nodeAt(at + glm::ivec3(x, y, z));
                if (other >= 0 && !isLoose(std::size_t(other)) && isOn(std::size_t(other), side))
                    return true;
            }
    return false;
}

} // namespace serosa::render
