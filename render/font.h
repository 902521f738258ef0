#pragma once
// A built-in bitmap font for captions: printable ASCII in 5x7 pixels.

#include "render/image.h"

#include <glm/glm.hpp>

#include <string>

namespace serosa::render {

constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kGlyphAdvance = 6;

/// Pixels that `text` takes at a scale.
inline int textWidth(const std::string& text, int scale) {
    return int(text.size()) * kGlyphAdvance * scale;
}

/// Draws `text` with its top left corner at (x, y); what falls outside the image is left out. Bytes that are
/// not printable ASCII draw as '?'.
void drawText(Image& image, const std::string& text, int x, int y, int scale, const glm::u8vec3& colour);

} // namespace serosa::render
