// What the kernels of sim/cpu_kernel.cpp share: included once for each instruction set.
#if defined(SEROSA_SIM_CPU_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SEROSA_SIM_CPU_LANES_INL_H
#undef SEROSA_SIM_CPU_LANES_INL_H
#else
#define SEROSA_SIM_CPU_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace serosa::sim::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Rows of organs are short: longer vectors would hold mostly pads.
constexpr std::size_t kMostLanes = 16;
using Lanes = hn::CappedTag<float, kMostLanes>;
using Vec = hn::Vec<Lanes>;
using Words = hn::Rebind<std::uint32_t, Lanes>;

// Rows of kCpuRows by direction.
enum Row { kSame = -1, kY, ky, kZ, kz, kYZ, kyz, kYz, kyZ };

/// The slot at dx in a neighbour row of a block's first slot.
HWY_INLINE std::size_t slotBeside(std::size_t slot, const std::int32_t* rows, int dx, Row row) {
    return std::size_t(std::ptrdiff_t(slot) + dx + (row == kSame ? 0 : rows[row]));
}

/// Lanes in which a bit is set.
HWY_INLINE hn::Mask<Lanes> lanesWith(Lanes d, hn::Vec<Words> bits, std::uint32_t bit) {
    return hn::RebindMask(d, hn::TestBit(bits, hn::Set(Words(), bit)));
}

/// 1/sqrt(q), and exactly 1 at q = 1: the rest state then has no force at all.
HWY_INLINE Vec reciprocalRoot(Lanes d, Vec q) {
#if HWY_TARGET <= HWY_AVX2 && HWY_ARCH_X86
    // 12 bits, then Halley's step with fused products: within an ulp, and cheaper than a root and a division.
    const Vec y = hn::ApproximateReciprocalSqrt(q);
    const Vec error = hn::NegMulAdd(hn::Mul(q, y), y, hn::Set(d, 1.0f));
    return hn::MulAdd(hn::Mul(y, error), hn::MulAdd(error, hn::Set(d, 0.375f), hn::Set(d, 0.5f)), y);
#else
    return hn::Div(hn::Set(d, 1.0f), hn::Sqrt(q));
#endif
}

} // namespace serosa::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
