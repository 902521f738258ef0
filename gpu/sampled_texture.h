#pragma once
// Textures that drawing passes filter: volumes, and tiles that repeat. State textures are gpu::Texture2D.

#include "gpu/handles.h"

#include <cstdint>
#include <vector>

namespace serosa::gpu {

/// Volume of one level, linear filtering, clamped at its edges.
class Texture3D : public Handle {
public:
    Texture3D() = default;
    /// Along a side, that the current context has.
    static int mostTexels();
    /// RGBA8. As an image its texel is one uint32, r in the lowest byte: atomics work on it.
    Texture3D(const std::string& label, const glm::ivec3& size);
    /// \param format as Texture2D's; R32UI is not filtered
    Texture3D(const std::string& label, GLenum format, const glm::ivec3& size);
    Texture3D(Texture3D&&) noexcept = default;
    Texture3D& operator=(Texture3D&& other) noexcept;
    ~Texture3D();
    GLenum format() const { return format_; }
    const glm::ivec3& size() const { return size_; }
    std::size_t bytes() const; // on the GPU
    /// RGBA8: one word a texel, x fastest.
    void upload(const std::vector<std::uint32_t>& texels);
    std::vector<std::uint32_t> download() const;
    /// Any format: tightly packed, x fastest. \param type of a component, GL_HALF_FLOAT, GL_FLOAT, ...
    void upload(GLenum layout, GLenum type, const void* data);
    void download(GLenum layout, GLenum type, std::size_t bytes, void* data) const;
    /// Fills with one texel (RGBA8, R32UI).
    void clear(std::uint32_t texel);

private:
    GLenum format_ = 0;
    glm::ivec3 size_{0};
};

/// 2D texture with all its levels, trilinear filtering, repeating.
class TiledTexture : public Handle {
public:
    TiledTexture() = default;
    /// \param format GL_RGBA8 or GL_SRGB8_ALPHA8. \param rgba four bytes a texel, row 0 first
    TiledTexture(const std::string& label, GLenum format, int width, int height,
                 const std::vector<std::uint8_t>& rgba);
    TiledTexture(TiledTexture&&) noexcept = default;
    TiledTexture& operator=(TiledTexture&& other) noexcept;
    ~TiledTexture();
};

} // namespace serosa::gpu
