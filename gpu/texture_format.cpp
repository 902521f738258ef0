// The internal formats that the program uses. Half floats travel as float32: no part keeps half floats on the
// CPU.

#include "gpu/texture_format.h"

namespace serosa::gpu {

namespace {

constexpr TextureFormat kFormats[] = {
    {GL_R32F, GL_RED, GL_FLOAT, 4, TexelKind::floating},
    {GL_RG32F, GL_RG, GL_FLOAT, 8, TexelKind::floating},
    {GL_RGB32F, GL_RGB, GL_FLOAT, 12, TexelKind::floating},
    {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16, TexelKind::floating},
    {GL_R16F, GL_RED, GL_FLOAT, 4, TexelKind::floating},
    {GL_RG16F, GL_RG, GL_FLOAT, 8, TexelKind::floating},
    {GL_RGBA16F, GL_RGBA, GL_FLOAT, 16, TexelKind::floating},
    {GL_R11F_G11F_B10F, GL_RGB, GL_FLOAT, 12, TexelKind::floating},
    {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1, TexelKind::floating},
    {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, 2, TexelKind::floating},
    {GL_RGB8, GL_RGB, GL_UNSIGNED_BYTE, 3, TexelKind::floating},
    {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4, TexelKind::floating},
    {GL_SRGB8, GL_RGB, GL_UNSIGNED_BYTE, 3, TexelKind::floating},
    {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4, TexelKind::floating},
    {GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1, TexelKind::unsignedInteger},
    {GL_R16UI, GL_RED_INTEGER, GL_UNSIGNED_SHORT, 2, TexelKind::unsignedInteger},
    {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4, TexelKind::unsignedInteger},
    {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 8, TexelKind::unsignedInteger},
    {GL_RGBA8UI, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, 4, TexelKind::unsignedInteger},
    {GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, 8, TexelKind::unsignedInteger},
    {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16, TexelKind::unsignedInteger},
    {GL_R32I, GL_RED_INTEGER, GL_INT, 4, TexelKind::signedInteger},
    {GL_RG32I, GL_RG_INTEGER, GL_INT, 8, TexelKind::signedInteger},
    {GL_RGBA32I, GL_RGBA_INTEGER, GL_INT, 16, TexelKind::signedInteger},
    {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_FLOAT, 4, TexelKind::depth},
    {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4, TexelKind::depth},
};

} // namespace

const TextureFormat* findTextureFormat(GLenum internal) {
    for (const TextureFormat& format : kFormats)
        if (format.internal == internal)
            return &format;
    return nullptr;
}

} // namespace serosa::gpu
