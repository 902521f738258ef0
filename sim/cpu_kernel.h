#pragma once
// One step of a range of blocks of the CPU solver (sim/cpu_layout.h), in the widest vectors that this
// processor has: sim/cpu_kernel.cpp is compiled once for each instruction set and chosen among at run time.

#include "shaders/shared_constants.h"

#include <cstddef>
#include <cstdint>

namespace serosa::sim {

/// A tool during one step, lattice units (float32 of ToolMotion).
struct CpuTool {
    int mode = SRS_TOOL_NONE;
    float to[3] = {}, move[3] = {}; // centre at the end, motion in the step
    float radius = 0;
};

/// Arrays hold one value a slot, in lattice units, where nothing else is said.
struct CpuStep {
    const float* positions[3];
    const float* increments[3];
    float* nextPositions[3];
    float* nextIncrements[3];
    const float* weights;      // a block: 18 directions of `lanes` weights w; 0 where there is no spring
    const float* acceleration; // dt^2 k/(rho h^3) / mass share; 0 at fixed nodes and pads: they do not move
    const float* mass;         // mass shares
    const float* depth;        // below the surface at rest: Lattice::restDepth
    const std::uint32_t* heldBy;
    std::uint32_t* normals;   // packed
    const std::int32_t* rows; // eight a block
    std::size_t first;        // slot of the first block
    float drag;               // 1 - air drag dt
    float damping;            // damping time / dt
    float gravity[3];         // dt^2 g / h
    bool withNormals;         // write eq. 3
    int toolCount;
    CpuTool tools[SRS_MAX_TOOLS];
};

struct CpuKernel {
    const char* target; // the instruction set, as Highway names it
    std::size_t lanes;
    /// Steps the blocks first .. last - 1 and adds to `impulses` (three a tool) what each tool gave: mass
    /// shares times lattice units a step.
    void (*step)(const CpuStep& step, std::size_t first, std::size_t last, double* impulses);
};

/// The best kernel for this processor (of those that hwy::SetSupportedTargetsForTest leaves).
CpuKernel cpuKernel();

} // namespace serosa::sim
