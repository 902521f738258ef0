#pragma once
// Values on their way from the GPU to the CPU without a stall: memory that both see, and fences that say when
// the GPU is done with it.

#include "gpu/handles.h"

#include <cstddef>
#include <string>

namespace serosa::gpu {

/// What the GPU did so far. Like every GL object it needs its context, and dies before it.
class Fence {
public:
    Fence() = default;
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;
    Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
    Fence& operator=(Fence&& other) noexcept {
        std::swap(sync_, other.sync_);
        return *this;
    }
    ~Fence();
    explicit operator bool() const { return sync_ != nullptr; }

    /// Of all commands given before.
    static Fence now();
    /// Returns once they are done. No fence: at once.
    void wait() const;

private:
    GLsync sync_ = nullptr;
};

/// A buffer that the CPU may read at any time; what the GPU copied into it is right once a fence that was
/// made after the copy has passed.
class ReadbackBuffer : public Handle {
public:
    ReadbackBuffer() = default;
    ReadbackBuffer(const std::string& label, std::size_t bytes);
    ReadbackBuffer(ReadbackBuffer&& other) noexcept
        : Handle(std::move(other)), bytes_(std::exchange(other.bytes_, 0)),
          data_(std::exchange(other.data_, nullptr)) {}
    ReadbackBuffer& operator=(ReadbackBuffer&& other) noexcept;
    ~ReadbackBuffer();

    std::size_t bytes() const { return bytes_; }
    const void* data() const { return data_; }
    /// Lets the GPU copy bytes() of `from` (from its start) here.
    void copyFrom(const Buffer& from);

private:
    std::size_t bytes_ = 0;
    const void* data_ = nullptr;
};

} // namespace serosa::gpu
