// What a vector of nodes gathers from its eight cells: the forces of the volumetric term, and spring weights
// of cells that stiffen. Included once for each instruction set by sim/cpu_kernel.cpp.
#if defined(SEROSA_SIM_CPU_GATHER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SEROSA_SIM_CPU_GATHER_INL_H
#undef SEROSA_SIM_CPU_GATHER_INL_H
#else
#define SEROSA_SIM_CPU_GATHER_INL_H
#endif

#include "sim/cpu_kernel.h"
#include "sim/cpu_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace serosa::sim::HWY_NAMESPACE {

/// Adds the force of the cells of one row, a lane where that row has a node.
HWY_INLINE void addRowForce(Lanes d, const float* const* forces, std::size_t at, hn::Mask<Lanes> there,
                            Vec& fx, Vec& fy, Vec& fz) {
    fx = hn::Add(fx, hn::IfThenElseZero(there, hn::LoadU(d, forces[0] + at)));
    fy = hn::Add(fy, hn::IfThenElseZero(there, hn::LoadU(d, forces[1] + at)));
    fz = hn::Add(fz, hn::IfThenElseZero(there, hn::LoadU(d, forces[2] + at)));
}

/// Adds the forces of the volumetric term in units of k h.
HWY_INLINE void addVolume(Lanes d, const CpuStep& step, std::size_t slot, const std::int32_t* rows, Vec& fx,
                          Vec& fy, Vec& fz) {
    const auto bits = hn::Load(Words(), step.bits + slot);
    addRowForce(d, step.rowForces, slotBeside(slot, rows, 0, kyz), lanesWith(d, bits, kRowBelowYZ), fx, fy,
                fz);
    addRowForce(d, step.rowForces + 3, slotBeside(slot, rows, 0, kz), lanesWith(d, bits, kRowBelowZ), fx, fy,
                fz);
    addRowForce(d, step.rowForces + 6, slotBeside(slot, rows, 0, ky), lanesWith(d, bits, kRowBelowY), fx, fy,
                fz);
    fx = hn::Add(fx, hn::Load(d, step.rowForces[9] + slot));
    fy = hn::Add(fy, hn::Load(d, step.rowForces[10] + slot));
    fz = hn::Add(fz, hn::Load(d, step.rowForces[11] + slot));
}

HWY_INLINE Vec constantAt(Lanes d, const float* HWY_RESTRICT constants, std::size_t at,
                          hn::Mask<Lanes> there) {
    return hn::IfThenElseZero(there, hn::LoadU(d, constants + at));
}

/// The 18 weights of each lane, as CpuStep::weights. Sums go over x, then y, then z, as seen from the grid:
/// both ends of a spring add the same cells in the same order.
template <bool kFibres>
HWY_INLINE void weighSprings(Lanes d, const CpuStep& step, std::size_t slot, const std::int32_t* rows,
                             float* HWY_RESTRICT weights) {
    const std::size_t lanes = hn::Lanes(d);
    const auto bits = hn::Load(Words(), step.bits + slot);
    const auto yz = lanesWith(d, bits, kRowBelowYZ), z = lanesWith(d, bits, kRowBelowZ),
               y = lanesWith(d, bits, kRowBelowY);
    const std::size_t atYZ = slotBeside(slot, rows, 0, kyz), atZ = slotBeside(slot, rows, 0, kz),
                      atY = slotBeside(slot, rows, 0, ky);
    // Of the cell towards -x (a) or +x (A), -y (b) or +y (B), -z (c) or +z (C), by direction pair.
#define SEROSA_CONSTANTS(pair) step.stiffened[kFibres ? pair : 0]
#define SEROSA_abc(pair) constantAt(d, SEROSA_CONSTANTS(pair), atYZ - 1, yz)
#define SEROSA_Abc(pair) constantAt(d, SEROSA_CONSTANTS(pair), atYZ, yz)
#define SEROSA_aBc(pair) constantAt(d, SEROSA_CONSTANTS(pair), atZ - 1, z)
#define SEROSA_ABc(pair) constantAt(d, SEROSA_CONSTANTS(pair), atZ, z)
#define SEROSA_abC(pair) constantAt(d, SEROSA_CONSTANTS(pair), atY - 1, y)
#define SEROSA_AbC(pair) constantAt(d, SEROSA_CONSTANTS(pair), atY, y)
#define SEROSA_aBC(pair) hn::LoadU(d, SEROSA_CONSTANTS(pair) + slot - 1)
#define SEROSA_ABC(pair) hn::Load(d, SEROSA_CONSTANTS(pair) + slot)
#define SEROSA_EDGE(direction, c0, c1, c2, c3)                                                               \
    hn::Store(hn::IfThenElseZero(lanesWith(d, bits, 1u << direction),                                        \
                                 hn::Add(hn::Add(SEROSA_##c0(direction / 2), SEROSA_##c1(direction / 2)),    \
                                         hn::Add(SEROSA_##c2(direction / 2), SEROSA_##c3(direction / 2)))),  \
              d, weights + direction * lanes)
    // A diagonal has two cells, each with twice the constant of an edge.
#define SEROSA_DIAGONAL(direction, c0, c1)                                                                   \
    hn::Store(hn::IfThenElseZero(lanesWith(d, bits, 1u << direction),                                        \
                                 hn::Mul(hn::Set(d, 2.0f),                                                   \
                                         hn::Add(SEROSA_##c0(direction / 2), SEROSA_##c1(direction / 2)))),  \
              d, weights + direction * lanes)
    SEROSA_EDGE(0, Abc, ABc, AbC, ABC);
    SEROSA_EDGE(1, abc, aBc, abC, aBC);
    SEROSA_EDGE(2, aBc, ABc, aBC, ABC);
    SEROSA_EDGE(3, abc, Abc, abC, AbC);
    SEROSA_EDGE(4, abC, AbC, aBC, ABC);
    SEROSA_EDGE(5, abc, Abc, aBc, ABc);
    SEROSA_DIAGONAL(6, ABc, ABC);
    SEROSA_DIAGONAL(7, abc, abC);
    SEROSA_DIAGONAL(8, Abc, AbC);
    SEROSA_DIAGONAL(9, aBc, aBC);
    SEROSA_DIAGONAL(10, AbC, ABC);
    SEROSA_DIAGONAL(11, abc, aBc);
    SEROSA_DIAGONAL(12, Abc, ABc);
    SEROSA_DIAGONAL(13, abC, aBC);
    SEROSA_DIAGONAL(14, aBC, ABC);
    SEROSA_DIAGONAL(15, abc, Abc);
    SEROSA_DIAGONAL(16, aBc, ABc);
    SEROSA_DIAGONAL(17, abC, AbC);
#undef SEROSA_DIAGONAL
#undef SEROSA_EDGE
#undef SEROSA_ABC
#undef SEROSA_aBC
#undef SEROSA_AbC
#undef SEROSA_abC
#undef SEROSA_ABc
#undef SEROSA_aBc
#undef SEROSA_Abc
#undef SEROSA_abc
#undef SEROSA_CONSTANTS
}

} // namespace serosa::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
