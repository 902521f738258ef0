#include "render/font.h"
#include "render/image.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace serosa::render {
namespace {

namespace fs = std::filesystem;

class ImageFiles : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ =
            fs::temp_directory_path() /
            (std::string("serosa_image_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directory(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string bytes(const char* name) const {
        std::ifstream in(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    fs::path folder_;
};

Image gradient(int width, int height) {
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int value : {x * 7, y * 5, x * y})
                image.rgb.push_back(std::uint8_t(value));
    return image;
}

Image plain(int width, int height, std::uint8_t value) {
    return {width, height, std::vector<std::uint8_t>(std::size_t(width * height) * 3, value)};
}

TEST_F(ImageFiles, PngReturnsTheSamePixelsAndTheSameBytes) {
    const Image image = gradient(37, 23);
    ASSERT_TRUE(writePng(image, folder_ / "a.png").ok());
    ASSERT_TRUE(writePng(image, folder_ / "b.png").ok());
    EXPECT_EQ(bytes("a.png"), bytes("b.png"));
    EXPECT_EQ(bytes("a.png").substr(1, 3), "PNG");
    const auto back = readPng(folder_ / "a.png");
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(back.value().width, 37);
    EXPECT_EQ(back.value().height, 23);
    EXPECT_EQ(back.value().rgb, image.rgb);
}

TEST_F(ImageFiles, BadFilesAreErrorsThatNameThem) {
    ASSERT_TRUE(writePng(gradient(64, 64), folder_ / "whole.png").ok());
    const std::string whole = bytes("whole.png");
    std::ofstream(folder_ / "cut.png", std::ios::binary) << whole.substr(0, whole.size() / 2);
    std::ofstream(folder_ / "empty.png", std::ios::binary) << "";
    std::ofstream(folder_ / "text.png", std::ios::binary) << "not a picture at all";
    for (const char* name : {"cut.png", "empty.png", "text.png", "missing.png"}) {
        const auto read = readPng(folder_ / name);
        ASSERT_FALSE(read.ok()) << name;
        EXPECT_NE(read.error().message.find(name), std::string::npos) << read.error().message;
    }
    const Status status = writePng(gradient(4, 4), folder_ / "no_such_folder" / "a.png");
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("no_such_folder"), std::string::npos);
}

TEST(Image, ShrinkAveragesInLinearLight) {
    Image image = plain(4, 2, 0);
    for (std::size_t i = 0; i < 3; ++i)
        image.rgb[i] = image.rgb[12 + i] = 255; // two of the left four pixels are white
    const Image half = shrink(image, 2);
    ASSERT_EQ(half.width, 2);
    ASSERT_EQ(half.height, 1);
    EXPECT_EQ(half.rgb[0], 188); // sRGB of half the light
    EXPECT_EQ(half.rgb[3], 0);
    EXPECT_EQ(shrink(image, 4).rgb, image.rgb);
    EXPECT_EQ(shrink(plain(7, 5, 90), 2).rgb, plain(2, 2, 90).rgb);
}

TEST(Image, CompareTellsLargestAndMean) {
    Image a = plain(10, 10, 100), b = a;
    b.rgb[5] = 107;
    b.rgb[77] = 97;
    const ImageDifference difference = compareImages(a, b);
    EXPECT_EQ(difference.largest, 7);
    EXPECT_DOUBLE_EQ(difference.mean, 10 / 300.0);
    EXPECT_EQ(compareImages(a, a).largest, 0);
}

TEST(Image, ContactSheetPlacesTilesRowByRow) {
    const std::vector<Image> tiles = {plain(60, 40, 100), plain(60, 40, 150), plain(60, 40, 200)};
    const Image sheet = contactSheet(tiles, {"a", "b", "c"}, 2);
    const auto at = [&](int x, int y) { return int(sheet.rgb[std::size_t(y * sheet.width + x) * 3]); };
    const int margin = 4, cellHeight = 40 + 2 * margin + kGlyphHeight;
    EXPECT_EQ(sheet.width, 2 * 64 + margin);
    EXPECT_EQ(sheet.height, 2 * cellHeight + margin);
    EXPECT_EQ(at(margin + 30, margin + 20), 100);
    EXPECT_EQ(at(margin + 64 + 30, margin + 20), 150);
    EXPECT_EQ(at(margin + 30, margin + cellHeight + 20), 200);
    EXPECT_LT(at(margin + 64 + 30, margin + cellHeight + 20), 60); // no fourth tile
}

TEST(Font, LettersHaveInkAndStayInside) {
    Image image = plain(40, 9, 0);
    drawText(image, "I1", 1, 1, 1, {255, 255, 255});
    int ink = 0;
    for (const std::uint8_t value : image.rgb)
        ink += value != 0;
    EXPECT_EQ(ink / 3, 11 + 10);                                     // pixels of the two glyphs
    drawText(image, "clipped on all sides", -9, -3, 4, {255, 0, 0}); // writes nothing out of bounds (asan)
}

} // namespace
} // namespace serosa::render
