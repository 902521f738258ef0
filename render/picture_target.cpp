#include "render/picture_target.h"

#include "gpu/gl.h"

#include <algorithm>

namespace serosa::render {

namespace {

constexpr int kWantedSamples = 8; // silhouettes of thin vessels step visibly with 4

int availableSamples() {
    GLint colour = 1;
    glGetInternalformativ(GL_RENDERBUFFER, GL_SRGB8_ALPHA8, GL_SAMPLES, 1, &colour); // the most comes first
    GLint depth = 1;
    glGetInternalformativ(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, GL_SAMPLES, 1, &depth);
    return std::clamp(std::min(colour, depth), 1, kWantedSamples);
}

} // namespace

PictureTarget::PictureTarget(int width, int height)
    : width_(width), height_(height), samples_(availableSamples()),
      colour_("picture samples", GL_SRGB8_ALPHA8, width, height, samples_),
      depth_("picture depth", GL_DEPTH_COMPONENT32F, width, height, samples_),
      resolved_("picture", GL_SRGB8_ALPHA8, width, height), drawn_("picture, multisampled"),
      readable_("picture") {
    drawn_.attach(GL_COLOR_ATTACHMENT0, colour_);
    drawn_.attach(GL_DEPTH_ATTACHMENT, depth_);
    drawn_.setDrawBuffers(1);
    readable_.attach(GL_COLOR_ATTACHMENT0, resolved_);
    readable_.setDrawBuffers(1);
}

void PictureTarget::begin() const {
    drawn_.bind(width_, height_);
    const float farthest = 1;
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(drawn_.id(), GL_DEPTH, 0, &farthest);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_BLEND);
}

void PictureTarget::bind() const {
    drawn_.bind(width_, height_);
}

void PictureTarget::end() const {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    readable_.bind(width_, height_);
    glBlitNamedFramebuffer(drawn_.id(), readable_.id(), 0, 0, width_, height_, 0, 0, width_, height_,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void PictureTarget::show(int width, int height) const {
    // Without GL_FRAMEBUFFER_SRGB the bytes are copied as they are.
    glBlitNamedFramebuffer(readable_.id(), 0, 0, 0, width_, height_, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                           width == width_ && height == height_ ? GL_NEAREST : GL_LINEAR);
}

Image PictureTarget::read() const {
    const auto w = std::size_t(width_), h = std::size_t(height_);
    std::vector<std::uint8_t> rgba(w * h * 4);
    resolved_.download(rgba.data(), rgba.size());
    Image image{width_, height_, std::vector<std::uint8_t>(w * h * 3)};
    for (std::size_t y = 0; y < h; ++y)
        for (std::size_t x = 0; x < w; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                image.rgb[(y * w + x) * 3 + c] =
                    rgba[((h - 1 - y) * w + x) * 4 + c]; // GL's row 0 is the lowest
    return image;
}

} // namespace serosa::render
