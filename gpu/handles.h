#pragma once
// Move-only owners of GL objects, with labels (glObjectLabel) and direct state access. Ids are private to
// gpu/ users through id(); nothing else creates or deletes GL objects. All need a current context, and must
// die before it.

#include "gpu/gl.h"

#include <glm/glm.hpp>

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace serosa::gpu {

/// Common to all handles: a private id that only moves.
class Handle {
public:
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    GLuint id() const { return id_; }
    explicit operator bool() const { return id_ != 0; }

protected:
    Handle() = default;
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    GLuint id_ = 0;
};

/// Immutable-size buffer storage.
class Buffer : public Handle {
public:
    Buffer() = default;
    /// \param data may be null; bytes may be 0 (then one byte is allocated).
    Buffer(const std::string& label, std::size_t bytes, const void* data);
    template <class T>
    Buffer(const std::string& label, std::span<const T> items)
        : Buffer(label, items.size_bytes(), items.data()) {}
    Buffer(Buffer&&) noexcept = default;
    Buffer& operator=(Buffer&& other) noexcept;
    ~Buffer();
    std::size_t bytes() const { return bytes_; }
    void upload(std::size_t offset, std::size_t bytes, const void* data);
    void download(std::size_t offset, std::size_t bytes, void* data) const;
    /// Fills with zeros.
    void clear();

private:
    std::size_t bytes_ = 0;
};

/// 2D texture with immutable storage, nearest filtering and clamped edges (what state textures need).
class Texture2D : public Handle {
public:
    Texture2D() = default;
    /// \param format sized internal format, for example GL_RGBA32F, GL_RGBA32UI, GL_RGBA8, GL_SRGB8_ALPHA8,
    /// GL_DEPTH_COMPONENT32F
    Texture2D(const std::string& label, GLenum format, int width, int height);
    Texture2D(Texture2D&&) noexcept = default;
    Texture2D& operator=(Texture2D&& other) noexcept;
    ~Texture2D();
    GLenum format() const { return format_; }
    int width() const { return width_; }
    int height() const { return height_; }
    /// Whole image, tightly packed, row 0 first; component type follows the format (float, also for half
    /// floats and depth; uint8, uint16, uint32, int32).
    void upload(const void* data);
    void download(void* data, std::size_t bytes) const;
    /// Fills with a colour (float formats) / value (integer formats).
    void clear(const glm::vec4& value);
    void clear(const glm::uvec4& value);

private:
    GLenum format_ = 0;
    int width_ = 0, height_ = 0;
};

/// Renderbuffer, multisampled if samples > 0.
class Renderbuffer : public Handle {
public:
    Renderbuffer() = default;
    Renderbuffer(const std::string& label, GLenum format, int width, int height, int samples);
    Renderbuffer(Renderbuffer&&) noexcept = default;
    Renderbuffer& operator=(Renderbuffer&& other) noexcept;
    ~Renderbuffer();
};

class Framebuffer : public Handle {
public:
    Framebuffer() = default;
    explicit Framebuffer(const std::string& label);
    Framebuffer(Framebuffer&&) noexcept = default;
    Framebuffer& operator=(Framebuffer&& other) noexcept;
    ~Framebuffer();
    /// attachment: GL_COLOR_ATTACHMENT0 + i, GL_DEPTH_ATTACHMENT
    void attach(GLenum attachment, const Texture2D& texture);
    void attach(GLenum attachment, const Renderbuffer& buffer);
    /// Draws go to colour attachments 0 .. count-1.
    void setDrawBuffers(int count);
    /// For reading and drawing, with that viewport. Checked: aborts with the reason when incomplete.
    void bind(int width, int height) const;

private:
    std::string label_;
    mutable bool complete_ = false; // checked since the last change of attachments
};

class VertexArray : public Handle {
public:
    VertexArray() = default;
    explicit VertexArray(const std::string& label);
    VertexArray(VertexArray&&) noexcept = default;
    VertexArray& operator=(VertexArray&& other) noexcept;
    ~VertexArray();
    /// Float attribute `location` of `components` items of `type` at `offset` in vertices of `stride` bytes
    /// of `buffer`.
    void attribute(int location, const Buffer& buffer, int components, GLenum type, bool normalized,
                   int stride, int offset);
    /// Integer attribute (uint in the shader).
    void integerAttribute(int location, const Buffer& buffer, int components, GLenum type, int stride,
                          int offset);
    void indices(const Buffer& buffer); // 32-bit indices
};

/// Time that the GPU spends between begin and end (GL_TIME_ELAPSED); timers do not nest.
/// llvmpipe answers that query with the time of one tile, so on software GL the timer finishes all work at
/// both ends and reads the clock: right as a sum, but a pair of small passes no longer overlaps.
class GpuTimer : public Handle {
public:
    GpuTimer() = default;
    explicit GpuTimer(const std::string& label);
    GpuTimer(GpuTimer&&) noexcept = default;
    GpuTimer& operator=(GpuTimer&& other) noexcept;
    ~GpuTimer();
    void begin();
    void end();
    /// Waits for the result; milliseconds between begin and end. Both must have been called.
    double milliseconds() const;

private:
    bool software_ = false;
    bool running_ = false, ended_ = false;
    std::chrono::steady_clock::time_point start_, stop_; // software only
};

} // namespace serosa::gpu
