#pragma once
// The most multiply-adds that this processor does, in the instruction set that the CPU solver uses: what
// `cpu_share_of_fma_peak` is a share of.

#include <cstddef>

namespace serosa::bench {

/// `repeats` turns of independent multiply-adds in registers, on all cores.
void runMultiplyAdds(int repeats);
/// Floating-point operations of one turn, two a multiply-add.
std::size_t flopsOfMultiplyAdds();

} // namespace serosa::bench
