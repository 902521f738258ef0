// See bench/fma_peak.h. Twelve chains hide the latency of four cycles at two and three operations a cycle.
#include "bench/fma_peak.h"

#include <tbb/parallel_for.h>

#include <atomic>

// foreach_target.h comes before all that it repeats.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/fma_peak.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace serosa::bench::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr int kLoops = 2000, kOperations = 12; // a call; operations a loop

/// `seeds`: one a chain, each another number, so that the chains are not seen to be the same. Returns
/// something that depends on all, so that none is left out.
float multiplyAdds(const float* seeds) {
    const hn::CappedTag<float, 16> d; // as the solver's kernel
    const auto factor = hn::Set(d, 0.999f), addend = hn::Set(d, 0.001f);
    auto c0 = hn::Set(d, seeds[0]);
    auto c1 = hn::Set(d, seeds[1]);
    auto c2 = hn::Set(d, seeds[2]);
    auto c3 = hn::Set(d, seeds[3]);
    auto c4 = hn::Set(d, seeds[4]);
    auto c5 = hn::Set(d, seeds[5]);
    auto c6 = hn::Set(d, seeds[6]);
    auto c7 = hn::Set(d, seeds[7]);
    auto c8 = hn::Set(d, seeds[8]);
    auto c9 = hn::Set(d, seeds[9]);
    auto c10 = hn::Set(d, seeds[10]);
    auto c11 = hn::Set(d, seeds[11]);
    for (int loop = 0; loop < kLoops; ++loop) {
        c0 = hn::MulAdd(c0, factor, addend);
        c1 = hn::MulAdd(c1, factor, addend);
        c2 = hn::MulAdd(c2, factor, addend);
        c3 = hn::MulAdd(c3, factor, addend);
        c4 = hn::MulAdd(c4, factor, addend);
        c5 = hn::MulAdd(c5, factor, addend);
        c6 = hn::MulAdd(c6, factor, addend);
        c7 = hn::MulAdd(c7, factor, addend);
        c8 = hn::MulAdd(c8, factor, addend);
        c9 = hn::MulAdd(c9, factor, addend);
        c10 = hn::MulAdd(c10, factor, addend);
        c11 = hn::MulAdd(c11, factor, addend);
    }
    const auto sum =
        hn::Add(hn::Add(hn::Add(hn::Add(c0, c1), hn::Add(c2, c3)), hn::Add(hn::Add(c4, c5), hn::Add(c6, c7))),
                hn::Add(hn::Add(c8, c9), hn::Add(c10, c11)));
    return hn::GetLane(hn::SumOfLanes(d, sum));
}

std::size_t flopsOfCall() {
    return 2 * std::size_t(kLoops) * kOperations * hn::Lanes(hn::CappedTag<float, 16>());
}

} // namespace serosa::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace serosa::bench {

HWY_EXPORT(multiplyAdds);
HWY_EXPORT(flopsOfCall);

constexpr int kParts = 64; // of a turn, shared by the threads
constexpr int kChains = 12;

void runMultiplyAdds(int repeats) {
    std::atomic<float> sink = 0;
    tbb::parallel_for(0, kParts * repeats, [&sink](int part) {
        float seeds[kChains];
        for (int i = 0; i < kChains; ++i)
            seeds[i] = float(i + part % 7);
        sink.store(HWY_DYNAMIC_DISPATCH(multiplyAdds)(seeds), std::memory_order_relaxed);
    });
}

std::size_t flopsOfMultiplyAdds() {
    return kParts * HWY_DYNAMIC_DISPATCH(flopsOfCall)();
}

} // namespace serosa::bench
#endif
