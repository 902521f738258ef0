// Textures, renderbuffers and framebuffers.

#include "base/check.h"
#include "gpu/handles.h"
#include "gpu/label.h"
#include "gpu/texture_format.h"

#include <glm/gtc/type_ptr.hpp>

#include <array>
#include <cstdio>

namespace serosa::gpu {

namespace {

const TextureFormat& formatOf(GLenum internal) {
    const TextureFormat* format = findTextureFormat(internal);
    SEROSA_CHECK(format, "texture format " + std::to_string(internal) + " is not in gpu/texture_format.cpp");
    return *format;
}

std::string framebufferProblem(GLenum status) {
    switch (status) {
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
        return "an attachment is incomplete";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
        return "nothing is attached";
    case GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER:
        return "a draw buffer has no attachment";
    case GL_FRAMEBUFFER_INCOMPLETE_READ_BUFFER:
        return "the read buffer has no attachment";
    case GL_FRAMEBUFFER_UNSUPPORTED:
        return "the driver does not render to this combination of formats";
    case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE:
        return "the attachments differ in samples";
    default:
        return "status " + std::to_string(status);
    }
}

} // namespace

Texture2D::Texture2D(const std::string& label, GLenum format, int width, int height)
    : format_(format), width_(width), height_(height) {
    checkContext(label);
    formatOf(format);
    SEROSA_CHECK(width > 0 && height > 0,
                 label + ": a texture of " + std::to_string(width) + " x " + std::to_string(height));
    glCreateTextures(GL_TEXTURE_2D, 1, &id_);
    glTextureStorage2D(id_, 1, format, width, height);
    glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureParameteri(id_, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(id_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    labelObject(GL_TEXTURE, id_, label);
}

Texture2D& Texture2D::operator=(Texture2D&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(format_, other.format_);
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
    return *this;
}

Texture2D::~Texture2D() {
    if (id_) {
        checkContext("a texture that dies");
        glDeleteTextures(1, &id_);
    }
}

void Texture2D::upload(const void* data) {
    const TextureFormat& format = formatOf(format_);
    glTextureSubImage2D(id_, 0, 0, 0, width_, height_, format.layout, format.type, data);
}

void Texture2D::download(void* data, std::size_t bytes) const {
    const TextureFormat& format = formatOf(format_);
    const std::size_t needed =
        format.bytesPerTexel * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    SEROSA_CHECK(bytes == needed, "the image has " + std::to_string(needed) + " bytes, the caller's memory " +
                                      std::to_string(bytes));
    glGetTextureImage(id_, 0, format.layout, format.type, static_cast<GLsizei>(bytes), data);
}

void Texture2D::clear(const glm::vec4& value) {
    const TexelKind kind = formatOf(format_).kind;
    SEROSA_CHECK(kind == TexelKind::floating || kind == TexelKind::depth,
                 "an integer texture cleared with floats");
    glClearTexImage(id_, 0, kind == TexelKind::depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT,
                    glm::value_ptr(value));
}

void Texture2D::clear(const glm::uvec4& value) {
    const TexelKind kind = formatOf(format_).kind;
    SEROSA_CHECK(kind == TexelKind::unsignedInteger,
                 "a texture that holds no unsigned integers cleared with them");
    glClearTexImage(id_, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, glm::value_ptr(value));
}

Renderbuffer::Renderbuffer(const std::string& label, GLenum format, int width, int height, int samples) {
    checkContext(label);
    glCreateRenderbuffers(1, &id_);
    glNamedRenderbufferStorageMultisample(id_, samples, format, width, height);
    labelObject(GL_RENDERBUFFER, id_, label);
}

Renderbuffer& Renderbuffer::operator=(Renderbuffer&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
}

Renderbuffer::~Renderbuffer() {
    if (id_) {
        checkContext("a renderbuffer that dies");
        glDeleteRenderbuffers(1, &id_);
    }
}

Framebuffer::Framebuffer(const std::string& label) : label_(label) {
    checkContext(label);
    glCreateFramebuffers(1, &id_);
    labelObject(GL_FRAMEBUFFER, id_, label);
}

Framebuffer& Framebuffer::operator=(Framebuffer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(label_, other.label_);
    std::swap(complete_, other.complete_);
    return *this;
}

Framebuffer::~Framebuffer() {
    if (id_) {
        checkContext("a framebuffer that dies");
        glDeleteFramebuffers(1, &id_);
    }
}

void Framebuffer::attach(GLenum attachment, const Texture2D& texture) {
    glNamedFramebufferTexture(id_, attachment, texture.id(), 0);
    complete_ = false;
}

void Framebuffer::attach(GLenum attachment, const Renderbuffer& buffer) {
    glNamedFramebufferRenderbuffer(id_, attachment, GL_RENDERBUFFER, buffer.id());
    complete_ = false;
}

void Framebuffer::setDrawBuffers(int count) {
    constexpr std::size_t kMost = 8; // GL 4.5 promises that many
    SEROSA_CHECK(count >= 0 && count <= static_cast<int>(kMost), "0 to 8 draw buffers");
    std::array<GLenum, kMost> buffers{};
    for (int i = 0; i < count; ++i)
        buffers[static_cast<std::size_t>(i)] = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
    glNamedFramebufferDrawBuffers(id_, count, buffers.data());
    complete_ = false;
}

void Framebuffer::bind(int width, int height) const {
    if (!complete_) { // asked once: drivers validate the whole framebuffer for this
        const GLenum status = glCheckNamedFramebufferStatus(id_, GL_DRAW_FRAMEBUFFER);
        SEROSA_CHECK(status == GL_FRAMEBUFFER_COMPLETE,
                     "framebuffer " + label_ + ": " + framebufferProblem(status));
        complete_ = true;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, id_);
    glViewport(0, 0, width, height);
}

} // namespace serosa::gpu
