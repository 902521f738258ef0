// The bend of figure 6 (MS05 3.3.1), in closed form.

#include "app/pose.h"

#include "sim/packed_normal.h"
#include "sim/quantity.h"
#include "sim/solver.h"

#include <cmath>

namespace serosa::app {

namespace {

struct Extent {
    glm::dvec3 lowest{0}, highest{0}; // lattice units
    glm::dvec3 middle() const { return (lowest + highest) / 2.0; }
};

Extent restExtent(const sim::Lattice& lattice) {
    Extent extent{lattice.restPosition(0), lattice.restPosition(0)};
    for (std::size_t node = 1; node < lattice.nodeCount(); ++node) {
        extent.lowest = glm::min(extent.lowest, lattice.restPosition(node));
        extent.highest = glm::max(extent.highest, lattice.restPosition(node));
    }
    return extent;
}

} // namespace

std::vector<std::uint32_t> latticeNormals(const sim::Lattice& lattice,
                                          const std::vector<glm::dvec3>& positions) {
    std::vector<std::uint32_t> normals(lattice.nodeCount());
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        glm::dvec3 sum(0);
        for (int d = 0; d < 18; ++d)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0)
                sum += glm::normalize(positions[node] - positions[std::size_t(other)]);
        normals[node] = sim::packNormal(glm::vec3(sum));
    }
    return normals;
}

sim::LatticeState bentState(const sim::Lattice& lattice, double curvature) {
    sim::LatticeState state = sim::restState(lattice);
    const double bend = curvature * lattice.spacing; // per lattice unit
    if (bend == 0)
        return state;
    const glm::dvec3 middle = restExtent(lattice).middle();
    for (glm::dvec3& position : state.positions) {
        const glm::dvec3 p = position - middle;
        const double angle = p.x * bend, half = std::sin(angle / 2);
        // (R + y) (sin, cos) - (0, R) with R = 1 / bend, written so that it goes over into the straight line.
        position = middle + glm::dvec3(std::sin(angle) * (1 / bend + p.y),
                                       p.y * std::cos(angle) - 2 * half * half / bend, p.z);
    }
    state.normals = latticeNormals(lattice, state.positions);
    return state;
}

Status checkBend(const sim::Lattice& lattice, double bendRadius) {
    const Extent extent = restExtent(lattice);
    const double below = (extent.highest.y - extent.lowest.y) / 2 * lattice.spacing; // m
    if (below >= bendRadius)
        return Error{"organ.pose.bend_radius is " + sim::formatQuantity(bendRadius, sim::Dimension::length) +
                     ", but the lattice reaches " + sim::formatQuantity(below, sim::Dimension::length) +
                     " below its middle and would turn inside out: raise it"};
    return {};
}

} // namespace serosa::app
