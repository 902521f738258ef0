// MS05 eq. 1 and 3 for a vector of nodes at a time, float32: twin of sim/reference_solver.cpp and
// shaders/solver_kernel.glsl (what a step does stands in sim/solver.h). Each node sums its own 18 springs, in
// one order, so that neither threads nor blocks change a bit; both ends of a spring compute the same numbers
// with the sign turned, which keeps momentum.
#include "sim/cpu_kernel.h"

// foreach_target.h comes before all that it repeats.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/cpu_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/cpu_kernel-inl.h"
// clang-format on

#if HWY_ONCE
namespace serosa::sim {

HWY_EXPORT(kernelOfTarget);

CpuKernel cpuKernel() {
    return HWY_DYNAMIC_DISPATCH(kernelOfTarget)();
}

} // namespace serosa::sim
#endif
