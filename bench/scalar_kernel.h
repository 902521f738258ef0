#pragma once
// What a plain CPU program would do: float32, array of structures, one thread, one node after another. The
// yardstick of `scalar_over_fragment_...`; the same physics as shaders/solver_kernel.glsl.

#include "sim/solver.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::bench {

class ScalarKernel {
public:
    /// Tools are not supported (there are none in these benchmarks).
    explicit ScalarKernel(const sim::SolverSetup& setup);
    void setState(const sim::LatticeState& state);
    void advance(int count);
    /// Lattice units, one a node.
    glm::vec3 position(std::size_t node) const { return nodes_[node].position; }

private:
    struct Node {
        glm::vec3 position;  // lattice units
        glm::vec3 increment; // lattice units
        std::uint32_t normal;
        std::uint32_t connections; // 18 bits
        std::uint32_t fixed;
        std::array<std::uint8_t, 8> fills;
        std::array<std::int32_t, 18> neighbours; // indices; its own where there is none
    };
    void step();
    Node stepNode(const Node& node) const;

    std::vector<Node> nodes_, next_;
    float acceleration_, damping_, drag_; // as the uniforms of shaders/solver_kernel.glsl
    glm::vec3 gravity_;
};

} // namespace serosa::bench
