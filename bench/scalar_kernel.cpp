// See bench/scalar_kernel.h. Compiled with -O2 (bench/CMakeLists.txt), no intrinsics, no threads.

#include "bench/scalar_kernel.h"

#include "base/check.h"
#include "sim/packed_normal.h"

#include <cmath>

namespace serosa::bench {

namespace {

/// Spring weights in units of k/1020, in the order of shaders/shared_constants.h, with the sums over cells
/// shared between directions.
std::array<float, 18> weightsOf(const std::array<std::uint8_t, 8>& fills) {
    const std::array<std::uint8_t, 8>& f = fills;
    const int xy[4] = {f[0] + f[4], f[1] + f[5], f[2] + f[6], f[3] + f[7]}; // sums over z
    const int xz[4] = {f[0] + f[2], f[1] + f[3], f[4] + f[6], f[5] + f[7]}; // over y
    const int yz[4] = {f[0] + f[1], f[2] + f[3], f[4] + f[5], f[6] + f[7]}; // over x
    const int weights[18] = {xy[1] + xy[3], xy[0] + xy[2], xy[2] + xy[3], xy[0] + xy[1], yz[2] + yz[3],
                             yz[0] + yz[1], 2 * xy[3],     2 * xy[0],     2 * xy[1],     2 * xy[2],
                             2 * xz[3],     2 * xz[0],     2 * xz[1],     2 * xz[2],     2 * yz[3],
                             2 * yz[0],     2 * yz[1],     2 * yz[2]};
    std::array<float, 18> result;
    for (std::size_t d = 0; d < 18; ++d)
        result[d] = float(weights[d]);
    return result;
}

} // namespace

ScalarKernel::ScalarKernel(const sim::SolverSetup& setup) {
    SEROSA_CHECK(setup.lattice && setup.tools.empty(), "a lattice and no tools");
    const sim::Lattice& lattice = *setup.lattice;
    const double h = lattice.spacing, dt = setup.timeStep;
    acceleration_ = float(dt * dt * setup.tissue.stiffnessOverMass(h));
    damping_ = float(setup.tissue.dampingTime / dt);
    drag_ = float(1 - setup.tissue.airDrag * dt);
    gravity_ = glm::vec3(setup.gravity * (dt * dt / h));
    nodes_.resize(lattice.nodeCount());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        Node& node = nodes_[i];
        node.fixed = !setup.fixed.empty() && setup.fixed[i];
        node.connections = lattice.connections[i];
        node.fills = lattice.fills[i];
        for (int d = 0; d < 18; ++d) {
            const std::int64_t other = lattice.neighbour(i, d);
            node.neighbours[std::size_t(d)] = std::int32_t(other < 0 ? std::int64_t(i) : other);
        }
    }
    setState(sim::restState(lattice));
    next_ = nodes_;
}

void ScalarKernel::setState(const sim::LatticeState& state) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        nodes_[i].position = glm::vec3(state.positions[i]);
        nodes_[i].increment = glm::vec3(state.increments[i]);
        nodes_[i].normal = state.normals[i];
    }
}

void ScalarKernel::advance(int count) {
    for (int i = 0; i < count; ++i)
        step();
}

void ScalarKernel::step() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Node moved = stepNode(nodes_[i]);
        next_[i].position = moved.position;
        next_[i].increment = moved.increment;
        next_[i].normal = moved.normal;
    }
    std::swap(nodes_, next_);
}

ScalarKernel::Node ScalarKernel::stepNode(const Node& node) const {
    const std::array<float, 18> weights = weightsOf(node.fills);
    glm::vec3 force(0), normal(0);
    for (std::size_t d = 0; d < 18; ++d) {
        if ((node.connections >> d & 1) == 0)
            continue;
        const Node& other = nodes_[std::size_t(node.neighbours[d])];
        const float rest = d < 6 ? 1.0f : 1.41421356f;
        const glm::vec3 away = node.position - other.position;
        const float length = std::sqrt(glm::dot(away, away));
        const glm::vec3 unit = away * (1 / length);
        const float closing = damping_ * glm::dot(unit, node.increment - other.increment);
        force += (weights[d] * (rest - length - closing)) * unit;
        normal += unit;
    }
    Node moved;
    moved.normal = sim::packNormal(normal);
    if (node.fixed) {
        moved.position = node.position;
        moved.increment = glm::vec3(0);
        return moved;
    }
    int fills = 0;
    for (const std::uint8_t fill : node.fills)
        fills += fill;
    moved.increment = drag_ * node.increment + (acceleration_ * 2 / float(fills)) * force + gravity_;
    moved.position = node.position + moved.increment;
    return moved;
}

} // namespace serosa::bench
