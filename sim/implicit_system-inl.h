#pragma once
// What the files of ImplicitSystem share: loops over runs, on all threads or one, and sums whose order does
// not depend on them.

#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/cell_volumes.h"
#include "sim/implicit_system.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace serosa::sim {

inline constexpr std::size_t kImplicitRun = 512; // items that one thread takes at once

template <class Real>
Real restOf(std::size_t direction) {
    return direction < 6 ? Real(1) : Real(1.4142135623730951);
}

/// (+-1, +-1, +-1) of a cell's corner.
template <class Real>
glm::vec<3, Real> signOf(int corner) {
    return glm::vec<3, Real>(cornerSign(corner));
}

template <class Real>
template <class Work>
void ImplicitSystem<Real>::forEachRun(std::size_t count, const Work& work) const {
    const std::size_t runs = (count + kImplicitRun - 1) / kImplicitRun;
    const auto take = [&](std::size_t run) {
        work(run * kImplicitRun, std::min(count, (run + 1) * kImplicitRun));
    };
    if (parallel_ && runs > 1)
        tbb::parallel_for(std::size_t(0), runs, take);
    else
        for (std::size_t run = 0; run < runs; ++run)
            take(run);
}

template <class Real>
template <class Add>
std::array<double, 4> ImplicitSystem<Real>::sumRuns(std::size_t count, const Add& add) const {
    std::vector<std::array<double, 4>> sums((count + kImplicitRun - 1) / kImplicitRun, {0, 0, 0, 0});
    forEachRun(count, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            add(i, sums[first / kImplicitRun]);
    });
    std::array<double, 4> total{};
    for (const std::array<double, 4>& sum : sums)
        for (std::size_t k = 0; k < total.size(); ++k)
            total[k] += sum[k];
    return total;
}

} // namespace serosa::sim
