// What all solvers share but cuts (sim/cut_list.cpp).
#include "sim/solver.h"

#include "base/check.h"

#include <utility>

namespace serosa::sim {

std::vector<glm::dvec3> Solver::takeToolImpulses() {
    const std::vector<ToolLoad> loads = takeLoads();
    std::vector<glm::dvec3> impulses;
    for (std::size_t tool = 0; tool < setup().tools.size(); ++tool)
        impulses.push_back(loads[tool].impulse);
    return impulses;
}

void Solver::endFrame() {
    SEROSA_CHECK(frames_.size() < 3, "loads are taken once a frame");
    frames_.push_back(takeLoads());
}

std::optional<std::vector<ToolLoad>> Solver::frameLoads() {
    if (frames_.size() < 3)
        return std::nullopt;
    std::vector<ToolLoad> loads = std::move(frames_.front());
    frames_.erase(frames_.begin());
    return loads;
}

std::vector<std::vector<ToolLoad>> Solver::flushFrames() {
    return std::exchange(frames_, {});
}

void Solver::readNodes(std::span<const std::uint32_t> nodes, std::span<NodeMotion> motions) const {
    const LatticeState now = state();
    for (std::size_t i = 0; i < nodes.size(); ++i)
        motions[i] = {now.positions[nodes[i]], now.increments[nodes[i]], now.heldBy[nodes[i]] != 0};
}

void Solver::moveNodes(std::span<const std::uint32_t> nodes, std::span<const glm::dvec3> by) {
    LatticeState now = state();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        now.positions[nodes[i]] += by[i];
        now.increments[nodes[i]] += by[i];
    }
    setState(now);
}

StateTextures* Solver::replaceState(std::int64_t) {
    return nullptr;
}

} // namespace serosa::sim
