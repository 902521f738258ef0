#pragma once
// What a sized internal format means for transfers. Private to gpu/.

#include "gpu/gl.h"

#include <cstddef>

namespace serosa::gpu {

enum class TexelKind { floating, unsignedInteger, signedInteger, depth };

struct TextureFormat {
    GLenum internal; // GL_RGBA32F, ...
    GLenum layout;   // GL_RGBA, GL_RGBA_INTEGER, GL_DEPTH_COMPONENT, ...
    GLenum type;     // component type of upload and download
    std::size_t bytesPerTexel;
    TexelKind kind;
};

/// The entry of the table, or null for a format that it lacks.
const TextureFormat* findTextureFormat(GLenum internal);

} // namespace serosa::gpu
