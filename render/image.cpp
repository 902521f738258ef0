#include "render/image.h"

#include "base/atomic_file.h"
#include "base/check.h"
#include "render/font.h"

#include <png.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>

namespace serosa::render {

namespace {

std::size_t pixel(const Image& image, int x, int y) {
    return (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 3;
}

Image blank(int width, int height, std::uint8_t grey) {
    return {width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * 3, grey)};
}

const std::array<float, 256>& linearFromSrgb() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (int i = 0; i < 256; ++i) {
            const double s = i / 255.0;
            values[std::size_t(i)] = float(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
        }
        return values;
    }();
    return table;
}

std::uint8_t srgbFromLinear(float linear) {
    const double s =
        linear <= 0.0031308F ? 12.92 * linear : 1.055 * std::pow(double(linear), 1 / 2.4) - 0.055;
    return std::uint8_t(std::lround(std::fmin(std::fmax(s, 0.0), 1.0) * 255));
}

Image halve(const Image& image) {
    Image half = blank((image.width + 1) / 2, (image.height + 1) / 2, 0);
    const auto& linear = linearFromSrgb();
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            const int x1 = std::min(2 * x + 1, image.width - 1), y1 = std::min(2 * y + 1, image.height - 1);
            for (std::size_t c = 0; c < 3; ++c) {
                const float sum = linear[image.rgb[pixel(image, 2 * x, 2 * y) + c]] +
                                  linear[image.rgb[pixel(image, x1, 2 * y) + c]] +
                                  linear[image.rgb[pixel(image, 2 * x, y1) + c]] +
                                  linear[image.rgb[pixel(image, x1, y1) + c]];
                half.rgb[pixel(half, x, y) + c] = srgbFromLinear(0.25F * sum);
            }
        }
    return half;
}

png_image header(const Image& image) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = png_uint_32(image.width);
    png.height = png_uint_32(image.height);
    png.format = PNG_FORMAT_RGB;
    return png;
}

} // namespace

Status writePng(const Image& image, const std::filesystem::path& file) {
    SEROSA_CHECK(image.width > 0 && image.height > 0, "an empty image: " + file.string());
    png_image png = header(image);
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::byte> buffer(bytes);
    if (!png_image_write_to_memory(&png, buffer.data(), &bytes, 0, image.rgb.data(), 0, nullptr))
        return Error{file.string() + ": cannot encode the picture: " + png.message};
    return writeFileAtomically(file, std::span(buffer).first(bytes));
}

Result<Image> readPng(const std::filesystem::path& file) {
    std::error_code code;
    std::ifstream in(file, std::ios::binary);
    if (!in || std::filesystem::is_directory(file, code))
        return Error{file.string() + ": cannot be opened; check that the file exists and may be read"};
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (bytes.empty() || !png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()))
        return Error{file.string() + ": not a PNG file" +
                     (bytes.empty() ? " (it is empty)" : ": " + std::string(png.message))};
    png.format = PNG_FORMAT_RGB;
    if (png.width > 1U << 16 || png.height > 1U << 16) {
        png_image_free(&png);
        return Error{file.string() + ": larger than 65536 pixels along a side"};
    }
    Image image{int(png.width), int(png.height), std::vector<std::uint8_t>(PNG_IMAGE_SIZE(png))};
    if (!png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr))
        return Error{file.string() + ": damaged PNG file: " + png.message};
    return image;
}

Image contactSheet(const std::vector<Image>& tiles, const std::vector<std::string>& captions, int columns) {
    SEROSA_CHECK(!tiles.empty() && columns > 0, "a contact sheet needs tiles and columns");
    const int width = tiles[0].width, height = tiles[0].height, count = int(tiles.size());
    columns = std::min(columns, count);
    const int rows = (count + columns - 1) / columns;
    const int scale = std::max(1, width / 240), margin = std::max(4, width / 60);
    const bool anyCaption = !captions.empty();
    const int cellWidth = width + margin;
    const int cellHeight = height + margin + (anyCaption ? kGlyphHeight * scale + margin : 0);
    Image sheet = blank(columns * cellWidth + margin, rows * cellHeight + margin, 22);
    for (int i = 0; i < count; ++i) {
        const Image& tile = tiles[std::size_t(i)];
        SEROSA_CHECK(tile.width == width && tile.height == height, "tiles of a contact sheet differ in size");
        const int left = margin + i % columns * cellWidth, top = margin + i / columns * cellHeight;
        for (int y = 0; y < height; ++y)
            std::memcpy(&sheet.rgb[pixel(sheet, left, top + y)], &tile.rgb[pixel(tile, 0, y)],
                        std::size_t(width) * 3);
        if (std::size_t(i) < captions.size()) {
            const auto room = std::size_t(std::max(0, width / (kGlyphAdvance * scale)));
            drawText(sheet, captions[std::size_t(i)].substr(0, room), left, top + height + margin / 2, scale,
                     {206, 206, 206});
        }
    }
    return sheet;
}

Image shrink(const Image& image, int width) {
    SEROSA_CHECK(width > 0, "a picture cannot shrink to no width");
    Image result = image;
    while (result.width > width)
        result = halve(result);
    return result;
}

ImageDifference compareImages(const Image& a, const Image& b) {
    SEROSA_CHECK(a.width == b.width && a.height == b.height, "pictures to compare differ in size");
    ImageDifference difference;
    double sum = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        const int d = std::abs(int(a.rgb[i]) - int(b.rgb[i]));
        difference.largest = std::max(difference.largest, d);
        sum += d;
    }
    difference.mean = a.rgb.empty() ? 0 : sum / double(a.rgb.size());
    return difference;
}

} // namespace serosa::render
