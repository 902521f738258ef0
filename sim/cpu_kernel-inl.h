// The kernel of sim/cpu_kernel.cpp: included once for each instruction set.
#if defined(SEROSA_SIM_CPU_KERNEL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SEROSA_SIM_CPU_KERNEL_INL_H
#undef SEROSA_SIM_CPU_KERNEL_INL_H
#else
#define SEROSA_SIM_CPU_KERNEL_INL_H
#endif

#include "sim/cpu_cells-inl.h"
#include "sim/cpu_gather-inl.h"
#include "sim/cpu_kernel.h"
#include "sim/cpu_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace serosa::sim::HWY_NAMESPACE {

/// Along springs: none, in one proportion to all weights, or by a constant of each spring's own.
enum class Damping { none, shared, own };

/// Adds one spring of each lane: to the force in units of k h, and its direction to the sum of eq. 3 (times
/// the rest length).
template <Damping kDamping, bool kNormals, bool kDiagonal>
HWY_INLINE void addSpring(Lanes d, const CpuStep& step, const float* HWY_RESTRICT weight,
                          const float* HWY_RESTRICT damper, std::size_t other, Vec x, Vec y, Vec z, Vec ux,
                          Vec uy, Vec uz, Vec& fx, Vec& fy, Vec& fz, Vec& nx, Vec& ny, Vec& nz) {
    const Vec w = hn::Load(d, weight);
    const Vec dx = hn::Sub(x, hn::LoadU(d, step.positions[0] + other));
    const Vec dy = hn::Sub(y, hn::LoadU(d, step.positions[1] + other));
    const Vec dz = hn::Sub(z, hn::LoadU(d, step.positions[2] + other));
    Vec length2 = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
    if constexpr (kDiagonal)
        length2 = hn::Mul(length2, hn::Set(d, 0.5f));
    // Rest length over length.
    const Vec stretch = reciprocalRoot(d, hn::Max(length2, hn::Set(d, 1e-12f)));
    Vec pull = hn::Sub(stretch, hn::Set(d, 1.0f));
    if constexpr (kDamping == Damping::own)
        pull = hn::Mul(w, pull);
    if constexpr (kDamping != Damping::none) {
        const Vec vx = hn::Sub(ux, hn::LoadU(d, step.increments[0] + other));
        const Vec vy = hn::Sub(uy, hn::LoadU(d, step.increments[1] + other));
        const Vec vz = hn::Sub(uz, hn::LoadU(d, step.increments[2] + other));
        const Vec along = hn::MulAdd(dz, vz, hn::MulAdd(dy, vy, hn::Mul(dx, vx)));
        Vec damping;
        if constexpr (kDamping == Damping::own)
            damping = hn::Load(d, damper);
        else
            damping = hn::Set(d, kDiagonal ? 0.5f * step.damping : step.damping);
        pull = hn::NegMulAdd(hn::Mul(damping, along), hn::Mul(stretch, stretch), pull);
    }
    if constexpr (kDamping != Damping::own)
        pull = hn::Mul(w, pull);
    fx = hn::MulAdd(pull, dx, fx);
    fy = hn::MulAdd(pull, dy, fy);
    fz = hn::MulAdd(pull, dz, fz);
    if constexpr (kNormals) {
        const Vec unit = hn::IfThenElseZero(hn::Gt(w, hn::Zero(d)), stretch);
        nx = hn::MulAdd(unit, dx, nx);
        ny = hn::MulAdd(unit, dy, ny);
        nz = hn::MulAdd(unit, dz, nz);
    }
}

/// packNormal of sim/packed_normal.cpp, operation by operation.
HWY_INLINE void storePackedNormals(Lanes d, Vec x, Vec y, Vec z, std::uint32_t* HWY_RESTRICT out) {
    const hn::Rebind<std::int32_t, Lanes> di;
    const hn::Rebind<std::uint32_t, Lanes> du;
    const Vec zero = hn::Zero(d), one = hn::Set(d, 1.0f), minusOne = hn::Set(d, -1.0f);
    const Vec sum = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
    const auto some = hn::Gt(sum, zero);
    const Vec divisor = hn::IfThenElse(some, sum, one);
    const Vec nx = hn::IfThenElse(some, hn::Div(x, divisor), zero);
    const Vec ny = hn::IfThenElse(some, hn::Div(y, divisor), one);
    const Vec nz = hn::IfThenElse(some, hn::Div(z, divisor), zero);
    const auto below = hn::Lt(nz, zero);
    const Vec signX = hn::IfThenElse(hn::Ge(nx, zero), one, minusOne);
    const Vec signY = hn::IfThenElse(hn::Ge(ny, zero), one, minusOne);
    const Vec ex = hn::IfThenElse(below, hn::Mul(hn::Sub(one, hn::Abs(ny)), signX), nx);
    const Vec ey = hn::IfThenElse(below, hn::Mul(hn::Sub(one, hn::Abs(nx)), signY), ny);
    const Vec half = hn::Set(d, float(SRS_NORMAL_HALF_STEPS));
    const Vec shift = hn::Set(d, float(SRS_NORMAL_HALF_STEPS) + 0.5f);
    // Positive: the conversion truncates as floor does.
    const auto qx = hn::BitCast(du, hn::ConvertTo(di, hn::Add(hn::Mul(ex, half), shift)));
    const auto qy = hn::BitCast(du, hn::ConvertTo(di, hn::Add(hn::Mul(ey, half), shift)));
    const auto data = hn::Or(qx, hn::ShiftLeft<15>(qy));
    const auto low = hn::Or(hn::And(data, hn::Set(du, 0x7fffffu)), hn::Set(du, 0x800000u));
    const auto middle = hn::ShiftLeft<1>(hn::And(data, hn::Set(du, 0x1f800000u)));
    const auto high = hn::ShiftLeft<2>(hn::And(data, hn::Set(du, 0x20000000u)));
    hn::Store(hn::Or(low, hn::Or(middle, high)), du, out);
}

/// \param kCells what a pass over cells left enters; plain springs have a loop without it.
template <Damping kDamping, bool kNormals, bool kCells>
void stepRange(const CpuStep& step, std::size_t firstBlock, std::size_t lastBlock, float* longest2) {
    const Lanes d;
    Vec fastest2 = hn::Zero(d);
    const std::size_t lanes = hn::Lanes(d);
    HWY_ALIGN float stiffWeights[kCells ? SRS_NEIGHBOURS * kMostLanes : 1];
    for (std::size_t block = firstBlock; block < lastBlock; ++block) {
        const std::size_t slot = step.first + block * lanes;
        const float* weights = step.weights + block * SRS_NEIGHBOURS * lanes;
        const float* dampers =
            kDamping == Damping::own ? step.dampers + block * SRS_NEIGHBOURS * lanes : nullptr;
        const std::int32_t* rows = step.rows + block * 8;
        if constexpr (kCells) {
            if (step.stiffened[0]) {
                if (step.stiffened[1])
                    weighSprings<true>(d, step, slot, rows, stiffWeights);
                else
                    weighSprings<false>(d, step, slot, rows, stiffWeights);
                weights = stiffWeights;
            }
        }
        const Vec x = hn::Load(d, step.positions[0] + slot), y = hn::Load(d, step.positions[1] + slot),
                  z = hn::Load(d, step.positions[2] + slot);
        const Vec ux = hn::Load(d, step.increments[0] + slot), uy = hn::Load(d, step.increments[1] + slot),
                  uz = hn::Load(d, step.increments[2] + slot);
        Vec fx = hn::Zero(d), fy = fx, fz = fx, nx = fx, ny = fx, nz = fx;
#define SEROSA_SPRING(direction, diagonal, dx, row)                                                          \
    addSpring<kDamping, kNormals, diagonal>(                                                                 \
        d, step, weights + direction * lanes,                                                                \
        kDamping == Damping::own ? dampers + direction * lanes : nullptr, slotBeside(slot, rows, dx, row),   \
        x, y, z, ux, uy, uz, fx, fy, fz, nx, ny, nz)
        SEROSA_SPRING(0, false, 1, kSame);
        SEROSA_SPRING(1, false, -1, kSame);
        SEROSA_SPRING(2, false, 0, kY);
        SEROSA_SPRING(3, false, 0, ky);
        SEROSA_SPRING(4, false, 0, kZ);
        SEROSA_SPRING(5, false, 0, kz);
        if constexpr (kNormals) { // unit vectors of diagonals come out sqrt(2) too long, as all do from here
                                  // on
            const Vec diagonal = hn::Set(d, 1.41421356f);
            nx = hn::Mul(nx, diagonal);
            ny = hn::Mul(ny, diagonal);
            nz = hn::Mul(nz, diagonal);
        }
        SEROSA_SPRING(6, true, 1, kY);
        SEROSA_SPRING(7, true, -1, ky);
        SEROSA_SPRING(8, true, 1, ky);
        SEROSA_SPRING(9, true, -1, kY);
        SEROSA_SPRING(10, true, 1, kZ);
        SEROSA_SPRING(11, true, -1, kz);
        SEROSA_SPRING(12, true, 1, kz);
        SEROSA_SPRING(13, true, -1, kZ);
        SEROSA_SPRING(14, true, 0, kYZ);
        SEROSA_SPRING(15, true, 0, kyz);
        SEROSA_SPRING(16, true, 0, kYz);
        SEROSA_SPRING(17, true, 0, kyZ);
#undef SEROSA_SPRING
        if constexpr (kCells) {
            if (step.rowForces[0])
                addVolume(d, step, slot, rows, fx, fy, fz);
        }
        if constexpr (kNormals)
            storePackedNormals(d, nx, ny, nz, step.normals + slot);

        const Vec acceleration = hn::Load(d, step.acceleration + slot);
        const auto movable = hn::Gt(acceleration, hn::Zero(d));
        const Vec drag = hn::Set(d, step.drag);
        Vec vx = hn::MulAdd(drag, ux, hn::MulAdd(acceleration, fx, hn::Set(d, step.gravity[0])));
        Vec vy = hn::MulAdd(drag, uy, hn::MulAdd(acceleration, fy, hn::Set(d, step.gravity[1])));
        Vec vz = hn::MulAdd(drag, uz, hn::MulAdd(acceleration, fz, hn::Set(d, step.gravity[2])));
        vx = hn::IfThenElseZero(movable, vx);
        vy = hn::IfThenElseZero(movable, vy);
        vz = hn::IfThenElseZero(movable, vz);
        const Vec px = hn::Add(x, vx), py = hn::Add(y, vy), pz = hn::Add(z, vz);
        fastest2 = hn::Max(fastest2, hn::MulAdd(vz, vz, hn::MulAdd(vy, vy, hn::Mul(vx, vx))));
        hn::Store(px, d, step.nextPositions[0] + slot);
        hn::Store(py, d, step.nextPositions[1] + slot);
        hn::Store(pz, d, step.nextPositions[2] + slot);
        hn::Store(vx, d, step.nextIncrements[0] + slot);
        hn::Store(vy, d, step.nextIncrements[1] + slot);
        hn::Store(vz, d, step.nextIncrements[2] + slot);
    }
    *longest2 = hn::GetLane(hn::MaxOfLanes(d, fastest2));
}

template <Damping kDamping>
void stepDamped(const CpuStep& step, std::size_t first, std::size_t last, float* longest2) {
    if (step.bits)
        step.withNormals ? stepRange<kDamping, true, true>(step, first, last, longest2)
                         : stepRange<kDamping, false, true>(step, first, last, longest2);
    else
        step.withNormals ? stepRange<kDamping, true, false>(step, first, last, longest2)
                         : stepRange<kDamping, false, false>(step, first, last, longest2);
}

void stepBlocks(const CpuStep& step, std::size_t first, std::size_t last, float* longest2) {
    if (step.dampers)
        stepDamped<Damping::own>(step, first, last, longest2);
    else if (step.damping > 0)
        stepDamped<Damping::shared>(step, first, last, longest2);
    else
        stepDamped<Damping::none>(step, first, last, longest2);
}

CpuKernel kernelOfTarget() {
    return {hwy::TargetName(HWY_TARGET), hn::Lanes(Lanes()), stepBlocks, stretchBlocks, cellBlocks};
}

} // namespace serosa::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
