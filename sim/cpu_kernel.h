#pragma once
// One step of a range of blocks of the CPU solver (sim/cpu_layout.h), and the passes over cells before it, in
// the widest vectors that this processor has: sim/cpu_kernel.cpp is compiled once for each instruction set
// and chosen among at run time.

#include "shaders/shared_constants.h"

#include <cstddef>
#include <cstdint>

namespace serosa::sim {

/// Arrays hold one value a slot, in lattice units, where nothing else is said.
struct CpuStep {
    const float* positions[3];
    const float* increments[3];
    float* nextPositions[3];
    float* nextIncrements[3];
    const float* weights;      // a block: 18 directions of `lanes` weights w; 0 where there is no spring
    const float* acceleration; // dt^2 k/(rho h^3) / mass share; 0 at fixed nodes and pads: they do not move
    std::uint32_t* normals;    // packed
    const std::int32_t* rows;  // eight a block
    std::size_t first;         // slot of the first block
    float drag;                // 1 - air drag dt
    float damping;             // damping time / dt, of all springs; unless
    const float* dampers;      // not null: as `weights`, damping constants over dt and squared rest length

    // What a pass over the cells left (CpuCellPass); null: there is none.
    const std::uint32_t* bits;  // its connections, and kRow bits
    const float* rowForces[12]; // of the volumetric term, k h
    const float* stiffened[9];  // constants of cells, instead of `weights`; from [1] on only with fibres

    float gravity[3]; // dt^2 g / h
    bool withNormals; // write eq. 3
};

// Above the 18 connections: rows beside a node (sim/cpu_layout.h) that have a node at its x.
inline constexpr std::uint32_t kRowBelowYZ = 1u << 18, kRowBelowZ = 1u << 19, kRowBelowY = 1u << 20;

/// A material whose cells stiffen (MaterialShares).
struct CpuCurve {
    float spring[9];
    float bulk;
    float twoOverYoung;
    float bend;
    int turns;
    float strain[SRS_CURVE_BREAKS], gain[SRS_CURVE_BREAKS];
};

/// A pass over the cells at the positions before a step. A cell is at the slot of its lowest corner.
struct CpuCellPass {
    const float* positions[3];
    const std::int32_t* rows;  // eight a block
    std::size_t first;         // slot of the first block
    const std::uint32_t* bits; // of the node at the slot

    // The volumetric term; null: there is none. 0 where there is no cell, or where a cut runs through it.
    const float* bulk;     // f b
    const float* recovery; // f r
    /// Three a row: the force on the node at the slot, k h, of the cells there and before it, as if the node
    /// were at their +y, +z corners; at -y, +z; at +y, -z; at -y, -z.
    float* rowForces[12];

    // Stiffening; pairs = 0: there is none.
    int pairs;                       // of constants: 1, or with fibres 9
    float* stretches[9];             // energy of the spring in direction 2 i, in a cell of constant k; k h^2
    const float* constants[9];       // spring constant of a cell's edges along pair i; 0: no cell
    float* stiffened[9];             // the same as the cell has stiffened
    const std::uint32_t* material;   // of the cell
    const std::uint32_t* stiffening; // a block: materials with a curve among its cells, a bit each
    const CpuCurve* curves;          // a material
};

struct CpuKernel {
    const char* target; // the instruction set, as Highway names it
    std::size_t lanes;
    /// Steps the blocks first .. last - 1, and says the squared length of their longest increment.
    void (*step)(const CpuStep& step, std::size_t first, std::size_t last, float* longest2);
    /// Writes the stretches of the blocks first .. last - 1; only where cells stiffen.
    void (*stretch)(const CpuCellPass& pass, std::size_t first, std::size_t last);
    /// Then the stiffened constants and the forces of their cells: needs the stretches of all blocks.
    void (*cells)(const CpuCellPass& pass, std::size_t first, std::size_t last);
};

/// The best kernel for this processor (of those that hwy::SetSupportedTargetsForTest leaves).
CpuKernel cpuKernel();

} // namespace serosa::sim
