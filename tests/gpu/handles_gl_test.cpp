// Handles: bytes that go up come down, ownership moves, framebuffers check themselves; blending,
// multisampling, timers.

#include "gpu/handles.h"
#include "gpu/program.h"
#include "tests/gl_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace serosa::gpu {
namespace {

class GlHandles : public test::GlTest {};

/// Odd sizes: rows that are not multiples of four bytes show a wrong packing.
constexpr int kWidth = 7, kHeight = 5, kTexels = kWidth * kHeight;

template <class T>
void expectRoundTrip(GLenum format, int components, const std::vector<T>& values) {
    ASSERT_EQ(values.size(), static_cast<std::size_t>(kTexels * components));
    Texture2D texture("round trip", format, kWidth, kHeight);
    texture.upload(values.data());
    std::vector<T> back(values.size());
    texture.download(back.data(), back.size() * sizeof(T));
    EXPECT_EQ(std::memcmp(back.data(), values.data(), values.size() * sizeof(T)), 0) << "format " << format;
}

template <class T, class Make>
std::vector<T> values(int components, Make make) {
    std::vector<T> result(static_cast<std::size_t>(kTexels * components));
    for (T& value : result)
        value = make();
    return result;
}

TEST_F(GlHandles, TexturesReturnTheSameBytes) {
    std::mt19937 random(1);
    const auto real = [&] { return std::uniform_real_distribution<float>(-1e3f, 1e3f)(random); };
    const auto word = [&] { return static_cast<std::uint32_t>(random()); };
    const auto byte = [&] { return static_cast<std::uint8_t>(random() & 255u); };
    expectRoundTrip(GL_RGBA32F, 4, values<float>(4, real));
    expectRoundTrip(GL_R32F, 1, values<float>(1, real));
    expectRoundTrip(GL_RGBA32UI, 4, values<std::uint32_t>(4, word));
    expectRoundTrip(GL_R32UI, 1, values<std::uint32_t>(1, word));
    expectRoundTrip(GL_RGBA8, 4, values<std::uint8_t>(4, byte));
    expectRoundTrip(GL_RGB8, 3, values<std::uint8_t>(3, byte));
    expectRoundTrip(GL_R8, 1, values<std::uint8_t>(1, byte));
    expectRoundTrip(GL_SRGB8_ALPHA8, 4, values<std::uint8_t>(4, byte));
    expectRoundTrip(GL_RGBA16UI, 4,
                    values<std::uint16_t>(4, [&] { return static_cast<std::uint16_t>(random()); }));
    expectRoundTrip(GL_DEPTH_COMPONENT32F, 1, values<float>(1, [&] {
                        return std::uniform_real_distribution<float>(0.0f, 1.0f)(random);
                    }));
}

TEST_F(GlHandles, PackedBitsInAFloatTextureSurvive) {
    // State textures keep packed normals in alpha: any bits but those of NaN, infinity and denormals.
    std::mt19937 random(2);
    std::vector<float> packed(static_cast<std::size_t>(kTexels) * 4);
    for (float& value : packed)
        value = std::bit_cast<float>((static_cast<std::uint32_t>(random()) | 0x40000000u) & ~0x00800000u);
    expectRoundTrip(GL_RGBA32F, 4, packed);
}

TEST_F(GlHandles, TexturesClear) {
    Texture2D real("real", GL_RGBA32F, kWidth, kHeight);
    real.clear(glm::vec4(-1, 2, 3.5f, 1e6f));
    std::array<glm::vec4, kTexels> realTexels{};
    real.download(realTexels.data(), sizeof realTexels);
    for (const glm::vec4& texel : realTexels)
        EXPECT_EQ(texel, glm::vec4(-1, 2, 3.5f, 1e6f));
    Texture2D whole("whole", GL_RGBA32UI, kWidth, kHeight);
    whole.clear(glm::uvec4(1, 2, 3, 0xffffffffu));
    std::array<glm::uvec4, kTexels> wholeTexels{};
    whole.download(wholeTexels.data(), sizeof wholeTexels);
    for (const glm::uvec4& texel : wholeTexels)
        EXPECT_EQ(texel, glm::uvec4(1, 2, 3, 0xffffffffu));
    EXPECT_DEATH(whole.clear(glm::vec4(0)), "integer texture cleared with floats");
    EXPECT_DEATH(real.clear(glm::uvec4(0)), "holds no unsigned integers");
}

TEST_F(GlHandles, BrokenPromisesAreNamed) {
    EXPECT_DEATH(Texture2D("flat", GL_RGBA8, 0, 4), "flat: a texture of 0 x 4");
    EXPECT_DEATH(Texture2D("odd", GL_COMPRESSED_RED, 4, 4), "is not in gpu/texture_format.cpp");
    const Texture2D texture("small", GL_RGBA8, 2, 2);
    std::array<std::uint8_t, 15> tooSmall{};
    EXPECT_DEATH(texture.download(tooSmall.data(), tooSmall.size()), "has 16 bytes, the caller's memory 15");
    Buffer buffer("four", 4, nullptr);
    EXPECT_DEATH(buffer.upload(2, 3, tooSmall.data()), "past the end");
    EXPECT_DEATH(buffer.download(5, 0, tooSmall.data()), "past the end");
}

TEST_F(GlHandles, BuffersReturnTheSameBytesAndMayBeEmpty) {
    const std::vector<int> numbers = {1, 2, 3, 4};
    Buffer buffer("numbers", std::span<const int>(numbers));
    EXPECT_EQ(buffer.bytes(), 16u);
    const int nine = 9;
    buffer.upload(8, sizeof nine, &nine);
    std::array<int, 3> back{};
    buffer.download(4, sizeof back, back.data());
    EXPECT_EQ(back, (std::array<int, 3>{2, 9, 4}));
    const Buffer empty("empty", 0, nullptr);
    EXPECT_TRUE(empty);
    EXPECT_EQ(empty.bytes(), 0u);
}

TEST_F(GlHandles, OwnershipMovesAndTheLastOwnerDeletes) {
    GLuint id = 0, replaced = 0;
    {
        Texture2D first("first", GL_RGBA8, 2, 3);
        id = first.id();
        Texture2D second(std::move(first));
        EXPECT_FALSE(first);
        EXPECT_EQ(second.id(), id);
        EXPECT_EQ(second.width(), 2);
        Texture2D third("third", GL_R8, 1, 1);
        replaced = third.id();
        third = std::move(second);
        EXPECT_EQ(third.id(), id);
        EXPECT_EQ(third.height(), 3);
        EXPECT_EQ(third.format(), static_cast<GLenum>(GL_RGBA8));
        second = Texture2D();
        EXPECT_FALSE(glIsTexture(replaced));
        EXPECT_TRUE(glIsTexture(id));
    }
    EXPECT_FALSE(glIsTexture(id));
}

TEST_F(GlHandles, LabelsReachGl) {
    const Buffer buffer("positions of the heart", 4, nullptr);
    std::array<char, 64> label{};
    GLsizei length = 0;
    glGetObjectLabel(GL_BUFFER, buffer.id(), label.size(), &length, label.data());
    EXPECT_EQ(std::string(label.data(), static_cast<std::size_t>(length)), "positions of the heart");
    const Buffer longName(std::string(1000, 'x'), 4, nullptr); // cut, not a GL error
}

TEST_F(GlHandles, AnIncompleteFramebufferAbortsWithTheReason) {
    const Framebuffer empty("empty");
    EXPECT_DEATH(empty.bind(4, 4), "framebuffer empty: nothing is attached");
    const Texture2D colour("colour", GL_RGBA8, 4, 4);
    const Renderbuffer depth("depth", GL_DEPTH_COMPONENT24, 4, 4, 4);
    Framebuffer mixed("mixed");
    mixed.attach(GL_COLOR_ATTACHMENT0, colour);
    mixed.bind(4, 4);
    mixed.attach(GL_DEPTH_ATTACHMENT, depth); // 4 samples beside none: checked again after the change
    EXPECT_DEATH(mixed.bind(4, 4), "the attachments differ in samples");
}

TEST_F(GlHandles, SeveralTargetsBlendEachInItsOwnWay) {
    auto program = Program::create(ShaderLibrary(), {"pass.vert", "constant.frag"});
    ASSERT_TRUE(program.ok()) << program.error().message;
    Texture2D target("sum", GL_RGBA32F, kWidth, kHeight);
    target.clear(glm::vec4(1, 1, 1, 1));
    Framebuffer framebuffer("sum");
    framebuffer.attach(GL_COLOR_ATTACHMENT0, target);
    framebuffer.bind(kWidth, kHeight);
    const VertexArray empty("empty");
    program->set("u_value", glm::vec4(0.25f, -2, 1e5f, 1)).use();
    glEnablei(GL_BLEND, 0);
    glBlendFunci(0, GL_ONE, GL_ONE);
    glColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
    for (int i = 0; i < 4; ++i)
        drawFullScreen(empty);
    glColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    std::array<glm::vec4, kTexels> texels{};
    target.download(texels.data(), sizeof texels);
    for (const glm::vec4& texel : texels)
        EXPECT_EQ(texel, glm::vec4(2, -7, 400001, 1));
}

TEST_F(GlHandles, AMultisampledEdgeResolvesToAMixture) {
    // A triangle whose edge runs along the diagonal of the image: pixels on the diagonal are covered in part.
    constexpr int kSide = 16;
    const std::array<glm::vec2, 3> corners = {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(-1, 1)};
    const Buffer vertices("corners", std::span<const glm::vec2>(corners));
    const std::array<std::uint32_t, 3> order = {0, 1, 2};
    const Buffer indices("order", std::span<const std::uint32_t>(order));
    VertexArray triangle("triangle");
    triangle.attribute(0, vertices, 2, GL_FLOAT, false, sizeof(glm::vec2), 0);
    triangle.indices(indices);

    const Renderbuffer samples("samples", GL_RGBA8, kSide, kSide, 4);
    Framebuffer multisampled("multisampled"), resolved("resolved");
    multisampled.attach(GL_COLOR_ATTACHMENT0, samples);
    const Texture2D image("image", GL_RGBA8, kSide, kSide);
    resolved.attach(GL_COLOR_ATTACHMENT0, image);
    resolved.bind(kSide, kSide);
    multisampled.bind(kSide, kSide);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    auto program = Program::create(ShaderLibrary(std::filesystem::path(SEROSA_SOURCE_DIR) / "tests/gpu"),
                                   {"corners.vert", "white.frag"});
    ASSERT_TRUE(program.ok()) << program.error().message;
    program->use();
    glBindVertexArray(triangle.id());
    glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT, nullptr);
    glBlitNamedFramebuffer(multisampled.id(), resolved.id(), 0, 0, kSide, kSide, 0, 0, kSide, kSide,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
    std::vector<std::array<std::uint8_t, 4>> pixels(kSide * kSide);
    image.download(pixels.data(), pixels.size() * 4);
    const auto red = [&](int x, int y) {
        return static_cast<int>(pixels[static_cast<std::size_t>(y * kSide + x)][0]);
    };
    EXPECT_EQ(red(1, 1), 255) << "row 0 is at the bottom, where the right angle lies";
    EXPECT_EQ(red(kSide - 2, kSide - 2), 0);
    for (int i = 0; i < kSide; ++i) {
        EXPECT_GT(red(i, kSide - 1 - i), 0) << i;
        EXPECT_LT(red(i, kSide - 1 - i), 255) << i;
    }
}

TEST_F(GlHandles, TimersTellMoreWorkFromLess) {
    auto program = Program::create(ShaderLibrary(), {"pass.vert", "constant.frag"});
    ASSERT_TRUE(program.ok()) << program.error().message;
    constexpr int kSide = 512;
    const Texture2D target("target", GL_RGBA32F, kSide, kSide);
    Framebuffer framebuffer("target");
    framebuffer.attach(GL_COLOR_ATTACHMENT0, target);
    framebuffer.bind(kSide, kSide);
    const VertexArray empty("empty");
    program->set("u_value", glm::vec4(1)).use();
    drawFullScreen(empty); // compiles the shader's final form
    glFinish();
    GpuTimer one("one"), many("many");
    double shortest = 1e9; // of several: a busy machine must not turn the answer
    for (int i = 0; i < 5; ++i) {
        one.begin();
        drawFullScreen(empty);
        one.end();
        shortest = std::min(shortest, one.milliseconds());
    }
    many.begin();
    for (int i = 0; i < 50; ++i)
        drawFullScreen(empty);
    many.end();
    EXPECT_GT(shortest, 0.0);
    EXPECT_GT(many.milliseconds(), 5.0 * shortest);
    EXPECT_LT(many.milliseconds(), 60e3);
    EXPECT_DEATH(one.end(), "end of a timer that was not begun");
    EXPECT_DEATH(static_cast<void>(GpuTimer("idle").milliseconds()), "not begun and ended");
}

} // namespace
} // namespace serosa::gpu
