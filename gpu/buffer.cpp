// Buffers and vertex arrays.

#include "base/check.h"
#include "gpu/handles.h"
#include "gpu/label.h"

namespace serosa::gpu {

Buffer::Buffer(const std::string& label, std::size_t bytes, const void* data) : bytes_(bytes) {
    checkContext(label);
    glCreateBuffers(1, &id_);
    glNamedBufferStorage(id_, static_cast<GLsizeiptr>(bytes ? bytes : 1), bytes ? data : nullptr,
                         GL_DYNAMIC_STORAGE_BIT);
    labelObject(GL_BUFFER, id_, label);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

Buffer::~Buffer() {
    if (id_) {
        checkContext("a buffer that dies");
        glDeleteBuffers(1, &id_);
    }
}

void Buffer::upload(std::size_t offset, std::size_t bytes, const void* data) {
    SEROSA_CHECK(offset <= bytes_ && bytes <= bytes_ - offset, "upload past the end of a buffer");
    glNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::download(std::size_t offset, std::size_t bytes, void* data) const {
    SEROSA_CHECK(offset <= bytes_ && bytes <= bytes_ - offset, "download past the end of a buffer");
    glGetNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::clear() {
    glClearNamedBufferData(id_, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
}

VertexArray::VertexArray(const std::string& label) {
    checkContext(label);
    glCreateVertexArrays(1, &id_);
    labelObject(GL_VERTEX_ARRAY, id_, label);
}

VertexArray& VertexArray::operator=(VertexArray&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
}

VertexArray::~VertexArray() {
    if (id_) {
        checkContext("a vertex array that dies");
        glDeleteVertexArrays(1, &id_);
    }
}

void VertexArray::attribute(int location, const Buffer& buffer, int components, GLenum type, bool normalized,
                            int stride, int offset) {
    const auto index = static_cast<GLuint>(location);
    glEnableVertexArrayAttrib(id_, index);
    glVertexArrayAttribFormat(id_, index, components, type, normalized ? GL_TRUE : GL_FALSE, 0);
    glVertexArrayVertexBuffer(id_, index, buffer.id(), offset, stride);
    glVertexArrayAttribBinding(id_, index, index);
}

void VertexArray::integerAttribute(int location, const Buffer& buffer, int components, GLenum type,
                                   int stride, int offset) {
    const auto index = static_cast<GLuint>(location);
    glEnableVertexArrayAttrib(id_, index);
    glVertexArrayAttribIFormat(id_, index, components, type, 0);
    glVertexArrayVertexBuffer(id_, index, buffer.id(), offset, stride);
    glVertexArrayAttribBinding(id_, index, index);
}

void VertexArray::indices(const Buffer& buffer) {
    glVertexArrayElementBuffer(id_, buffer.id());
}

} // namespace serosa::gpu
