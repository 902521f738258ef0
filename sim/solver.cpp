// What all solvers share but cuts (sim/cut_list.cpp).
#include "sim/solver.h"

namespace serosa::sim {

std::vector<glm::dvec3> Solver::takeToolImpulses() {
    const std::vector<ToolLoad> loads = takeLoads();
    std::vector<glm::dvec3> impulses;
    for (std::size_t tool = 0; tool < setup().tools.size(); ++tool)
        impulses.push_back(loads[tool].impulse);
    return impulses;
}

StateTextures* Solver::replaceState(std::int64_t) {
    return nullptr;
}

} // namespace serosa::sim
