// See gpu/readback.h.

#include "gpu/readback.h"

#include "base/check.h"
#include "gpu/label.h"

namespace serosa::gpu {

Fence::~Fence() {
    if (sync_) {
        checkContext("a fence that dies");
        glDeleteSync(sync_);
    }
}

Fence Fence::now() {
    checkContext("a fence");
    Fence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    SEROSA_CHECK(fence.sync_, "the driver makes a fence");
    glFlush(); // it must not wait for the next frame to be sent
    return fence;
}

void Fence::wait() const {
    constexpr GLuint64 kNanoseconds = 1'000'000'000;
    if (!sync_)
        return;
    GLenum state = GL_TIMEOUT_EXPIRED;
    while (state == GL_TIMEOUT_EXPIRED)
        state = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, kNanoseconds);
    SEROSA_CHECK(state != GL_WAIT_FAILED, "the driver waits for a fence");
}

ReadbackBuffer::ReadbackBuffer(const std::string& label, std::size_t bytes) : bytes_(bytes) {
    checkContext(label);
    SEROSA_CHECK(bytes > 0, label + ": a buffer of nothing");
    constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glCreateBuffers(1, &id_);
    glNamedBufferStorage(id_, static_cast<GLsizeiptr>(bytes), nullptr, kAccess | GL_CLIENT_STORAGE_BIT);
    data_ = glMapNamedBufferRange(id_, 0, static_cast<GLsizeiptr>(bytes), kAccess);
    SEROSA_CHECK(data_, label + ": the driver maps the buffer");
    labelObject(GL_BUFFER, id_, label);
}

ReadbackBuffer& ReadbackBuffer::operator=(ReadbackBuffer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(bytes_, other.bytes_);
    std::swap(data_, other.data_);
    return *this;
}

ReadbackBuffer::~ReadbackBuffer() {
    if (id_) {
        checkContext("a buffer that dies");
        glDeleteBuffers(1, &id_); // unmaps it, too
    }
}

void ReadbackBuffer::copyFrom(const Buffer& from) {
    SEROSA_CHECK(bytes_ <= from.bytes(), "a buffer that holds as much");
    glCopyNamedBufferSubData(from.id(), id_, 0, 0, static_cast<GLsizeiptr>(bytes_));
}

} // namespace serosa::gpu
