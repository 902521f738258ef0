// See sim/tool_loads.h.
#include "sim/tool_loads.h"

#include "base/check.h"
#include "shaders/shared_constants.h"
#include "sim/solver_program.h"

#include <cstdint>
#include <cstring>

namespace serosa::sim {

namespace {

constexpr std::size_t kComponents = 6; // impulse, moment
constexpr double kFixedPoint = 1.0 / (1ull << 40);

} // namespace

ToolLoads::ToolLoads(const SolverSetup& setup)
    : colliders_(setup.tools.size() + setup.bodies.size()), impulseUnit_(sim::impulseUnit(setup)),
      momentUnit_(impulseUnit_ * setup.lattice->spacing) {
    if (colliders_ == 0)
        return;
    const std::size_t bytes = SRS_LOAD_STRIPES * colliders_ * kComponents * sizeof(std::uint64_t);
    sums_ = gpu::Buffer("tool loads", bytes, nullptr);
    sums_.clear();
    for (Slot& slot : ring_)
        slot.buffer = gpu::ReadbackBuffer("tool loads of a frame", bytes);
}

std::vector<ToolLoad> ToolLoads::loadsOf(const void* sums) const {
    std::vector<std::uint64_t> words(colliders_ * kComponents, 0);
    const auto* bytes = static_cast<const unsigned char*>(sums);
    for (std::size_t stripe = 0; stripe < SRS_LOAD_STRIPES; ++stripe)
        for (std::uint64_t& word : words) {
            std::uint32_t half[2]; // low, high
            std::memcpy(half, bytes, sizeof half);
            bytes += sizeof half;
            word += std::uint64_t(half[1]) << 32 | half[0];
        }
    std::vector<ToolLoad> loads(colliders_);
    for (std::size_t i = 0; i < words.size(); ++i) {
        const double value = double(std::int64_t(words[i])) * kFixedPoint;
        ToolLoad& load = loads[i / kComponents];
        const auto component = glm::length_t(i % kComponents);
        if (component < 3)
            load.impulse[component] = value * impulseUnit_;
        else
            load.angular[component - 3] = value * momentUnit_;
    }
    return loads;
}

std::vector<ToolLoad> ToolLoads::take() {
    if (colliders_ == 0)
        return {};
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    std::vector<unsigned char> bytes(sums_.bytes());
    sums_.download(0, bytes.size(), bytes.data());
    sums_.clear();
    return loadsOf(bytes.data());
}

void ToolLoads::endFrame() {
    SEROSA_CHECK(pending_ < kRing, "loads are taken once a frame");
    Slot& slot = ring_[(oldest_ + pending_++) % kRing];
    if (colliders_ == 0)
        return;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    slot.buffer.copyFrom(sums_);
    sums_.clear();
    slot.done = gpu::Fence::now();
}

std::vector<ToolLoad> ToolLoads::takeOldest() {
    Slot& slot = ring_[oldest_];
    oldest_ = (oldest_ + 1) % kRing;
    --pending_;
    if (colliders_ == 0)
        return {};
    slot.done.wait();
    slot.done = gpu::Fence();
    return loadsOf(slot.buffer.data());
}

std::optional<std::vector<ToolLoad>> ToolLoads::frame() {
    if (pending_ < kRing)
        return std::nullopt;
    return takeOldest();
}

std::vector<std::vector<ToolLoad>> ToolLoads::flush() {
    std::vector<std::vector<ToolLoad>> frames;
    while (pending_ > 0)
        frames.push_back(takeOldest());
    return frames;
}

} // namespace serosa::sim
