// See gpu/sampled_texture.h.
#include "gpu/sampled_texture.h"

#include "base/check.h"
#include "gpu/label.h"
#include "gpu/texture_format.h"

#include <algorithm>
#include <bit>

namespace serosa::gpu {

namespace {

std::size_t texelsOf(const glm::ivec3& size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

} // namespace

int Texture3D::mostTexels() {
    GLint most = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
    return most;
}

Texture3D::Texture3D(const std::string& label, const glm::ivec3& size) : Texture3D(label, GL_RGBA8, size) {}

Texture3D::Texture3D(const std::string& label, GLenum format, const glm::ivec3& size)
    : format_(format), size_(size) {
    SEROSA_CHECK(findTextureFormat(format), label + ": a format that the table lacks");
    checkContext(label);
    SEROSA_CHECK(size.x > 0 && size.y > 0 && size.z > 0, label + ": a volume of nothing");
    glCreateTextures(GL_TEXTURE_3D, 1, &id_);
    glTextureStorage3D(id_, 1, format, size.x, size.y, size.z);
    const GLint filter =
        findTextureFormat(format)->kind == TexelKind::unsignedInteger ? GL_NEAREST : GL_LINEAR;
    glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, filter);
    glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, filter);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTextureParameteri(id_, wrap, GL_CLAMP_TO_EDGE);
    labelObject(GL_TEXTURE, id_, label);
}

Texture3D& Texture3D::operator=(Texture3D&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(format_, other.format_);
    std::swap(size_, other.size_);
    return *this;
}

Texture3D::~Texture3D() {
    if (id_) {
        checkContext("a volume that dies");
        glDeleteTextures(1, &id_);
    }
}

std::size_t Texture3D::bytes() const {
    const std::size_t texel =
        format_ == GL_RGBA8     ? 4
        : format_ == GL_R16F    ? 2
        : format_ == GL_RGBA16F ? 8
                                : findTextureFormat(format_)->bytesPerTexel; // half floats travel as float32
    return texel * texelsOf(size_);
}

void Texture3D::upload(GLenum layout, GLenum type, const void* data) {
    glTextureSubImage3D(id_, 0, 0, 0, 0, size_.x, size_.y, size_.z, layout, type, data);
}

void Texture3D::download(GLenum layout, GLenum type, std::size_t bytes, void* data) const {
    glGetTextureImage(id_, 0, layout, type, GLsizei(bytes), data);
}

void Texture3D::upload(const std::vector<std::uint32_t>& texels) {
    SEROSA_CHECK(texels.size() == texelsOf(size_), "one word a texel");
    glTextureSubImage3D(id_, 0, 0, 0, 0, size_.x, size_.y, size_.z, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
}

std::vector<std::uint32_t> Texture3D::download() const {
    std::vector<std::uint32_t> texels(texelsOf(size_));
    glGetTextureImage(id_, 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(bytes()), texels.data());
    return texels;
}

void Texture3D::clear(std::uint32_t texel) {
    if (format_ == GL_R32UI)
        glClearTexImage(id_, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &texel);
    else
        glClearTexImage(id_, 0, GL_RGBA, GL_UNSIGNED_BYTE, &texel);
}

TiledTexture::TiledTexture(const std::string& label, GLenum format, int width, int height,
                           const std::vector<std::uint8_t>& rgba) {
    checkContext(label);
    SEROSA_CHECK(width > 0 && height > 0 && rgba.size() == 4 * std::size_t(width) * std::size_t(height),
                 label + ": four bytes a texel");
    glCreateTextures(GL_TEXTURE_2D, 1, &id_);
    glTextureStorage2D(id_, std::bit_width(unsigned(std::max(width, height))), format, width, height);
    glTextureSubImage2D(id_, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    glGenerateTextureMipmap(id_);
    glTextureParameteri(id_, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(id_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(id_, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTextureParameteri(id_, GL_TEXTURE_WRAP_T, GL_REPEAT);
    labelObject(GL_TEXTURE, id_, label);
}

TiledTexture& TiledTexture::operator=(TiledTexture&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
}

TiledTexture::~TiledTexture() {
    if (id_) {
        checkContext("a texture that dies");
        glDeleteTextures(1, &id_);
    }
}

} // namespace serosa::gpu
