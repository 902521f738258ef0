#pragma once
// A loop over independent items on all cores. Results go to slots by index, so they do not depend on the
// number of cores.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace serosa::render {

/// Calls body(begin, end) for pieces of [0, count) in no promised order; body must not throw.
template <class Body>
void parallelFor(std::size_t count, const Body& body) {
    constexpr std::size_t kPiece = 512;
    const std::size_t threads =
        std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 1 + count / kPiece);
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t begin; (begin = next.fetch_add(kPiece)) < count;)
            body(begin, std::min(count, begin + kPiece));
    };
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < threads; ++i)
        others.emplace_back(work);
    work();
}

} // namespace serosa::render
