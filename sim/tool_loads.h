#pragma once
// What colliders gave, from the GPU's sums (shaders/contact_loads.glsl) to newtons: at once, which stalls, or
// frame by frame through a ring of three buffers, where the CPU reads what the GPU wrote two frames ago.

#include "gpu/readback.h"
#include "sim/solver.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace serosa::sim {

/// Of one solver on the GPU. Needs a current context where there is any collider.
class ToolLoads {
public:
    ToolLoads() = default;
    explicit ToolLoads(const SolverSetup& setup);

    /// The sums that shaders add to.
    const gpu::Buffer& sums() const { return sums_; }

    /// As Solver::takeLoads, endFrame, frameLoads and flushFrames.
    std::vector<ToolLoad> take();
    void endFrame();
    std::optional<std::vector<ToolLoad>> frame();
    std::vector<std::vector<ToolLoad>> flush();

private:
    static constexpr std::size_t kRing = 3;
    struct Slot {
        gpu::ReadbackBuffer buffer;
        gpu::Fence done;
    };
    std::vector<ToolLoad> loadsOf(const void* sums) const;
    std::vector<ToolLoad> takeOldest();

    std::size_t colliders_ = 0;
    double impulseUnit_ = 0, momentUnit_ = 0; // N s, N m s of 1 in lattice units
    gpu::Buffer sums_;
    Slot ring_[kRing];
    std::size_t oldest_ = 0, pending_ = 0; // slot, and how many wait from there on
};

} // namespace serosa::sim
