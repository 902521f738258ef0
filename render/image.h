#pragma once
// Pictures: 8-bit sRGB, top row first; PNG files written whole or not at all; contact sheets.

#include "base/result.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace serosa::render {

struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb; // width * height * 3
};

/// Deterministic bytes (no time stamps). Errors: folder missing, disk full; nothing is left under the final
/// name then.
Status writePng(const Image& image, const std::filesystem::path& file);
Result<Image> readPng(const std::filesystem::path& file);

/// Tiles of equal size, row by row, with a margin and the captions below each tile (built-in bitmap font).
Image contactSheet(const std::vector<Image>& tiles, const std::vector<std::string>& captions, int columns);

/// Halves the size by averaging in linear light until the width is at most `width`.
Image shrink(const Image& image, int width);

/// Largest and mean absolute difference a channel, 0..255; sizes must match.
struct ImageDifference {
    int largest = 0;
    double mean = 0;
};
ImageDifference compareImages(const Image& a, const Image& b);

} // namespace serosa::render
