// See app/verify/fem_picture.h. Colours rise in lightness from dark blue to yellow (the stops are those of
// matplotlib's viridis), so that the order stays visible without colour vision; the light is soft, so that
// shading does not hide it.
#include "app/verify/fem_picture.h"

#include "render/camera.h"
#include "render/font.h"
#include "render/surface_renderer.h"
#include "sim/state_textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace serosa::app {

namespace {

constexpr int kSide = 640, kBarRoom = 96; // pixels
constexpr glm::u8vec3 kPaper{255, 255, 255}, kInk{32, 32, 32}, kNotCompared{150, 150, 150};

glm::u8vec3 colourOf(double share) {
    constexpr std::array<glm::dvec3, 5> stops{
        {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
    const double place = std::clamp(share, 0.0, 1.0) * double(stops.size() - 1);
    const std::size_t first = std::min(std::size_t(place), stops.size() - 2);
    return glm::u8vec3(glm::mix(stops[first], stops[first + 1], place - double(first)) + 0.5);
}

void setPixel(render::Image& image, int x, int y, const glm::u8vec3& colour) {
    for (int c = 0; c < 3; ++c)
        image.rgb[std::size_t(3 * (y * image.width + x) + c)] = colour[c];
}

void drawBar(render::Image& image, double most, const std::string& text) {
    const int left = image.width / 4, width = image.width / 2, top = kSide + 36, height = 24;
    for (int x = 0; x < width; ++x)
        for (int y = 0; y < height; ++y)
            setPixel(image, left + x, top + y, colourOf((x + 0.5) / width));
    char end[32];
    std::snprintf(end, sizeof end, "%.3g%%", 100 * most);
    render::drawText(image, text, (image.width - render::textWidth(text, 2)) / 2, top - 26, 2, kInk);
    render::drawText(image, "0", left - 20, top + 5, 2, kInk);
    render::drawText(image, end, left + width + 8, top + 5, 2, kInk);
}

} // namespace

Result<render::Image> errorPicture(const sim::TriangleMesh& surface, const sim::Lattice& lattice,
                                   const std::vector<double>& shares, double most,
                                   const std::string& barText) {
    SEROSA_CHECK(shares.size() == surface.positions.size(), "a share for each vertex");
    sim::TriangleMesh coloured = surface;
    coloured.colours.clear();
    for (const double share : shares)
        coloured.colours.push_back(share < 0 ? kNotCompared : colourOf(share));
    SEROSA_ASSIGN(const sim::StateTextures state, sim::StateTextures::create(lattice, {}));
    SEROSA_ASSIGN(render::SurfaceRenderer renderer,
                  render::SurfaceRenderer::create(
                      lattice, coloured, render::bindSurface(lattice, coloured, sim::Mapping::curvature),
                      state, kSide, kSide));
    render::Image image{2 * kSide, kSide + kBarRoom, {}};
    image.rgb.assign(std::size_t(3 * image.width * image.height), kPaper.x);
    for (int side = 0; side < 2; ++side) { // from the front, and from behind
        render::View view;
        sim::Camera camera;
        camera.projection = sim::Projection::orthographic;
        camera.direction = side == 0 ? glm::dvec3(0, -0.15, -1) : glm::dvec3(0, -0.15, 1);
        view.camera = render::makeCamera(camera, coloured.lowest(), coloured.highest(), 1);
        view.light.direction = camera.direction;
        view.light.intensity = 0.5;
        view.light.ambient = 2;
        renderer.draw(state, view);
        const render::Image half = renderer.readImage();
        for (int y = 0; y < kSide; ++y)
            std::copy_n(&half.rgb[std::size_t(3 * y * kSide)], 3 * kSide,
                        &image.rgb[std::size_t(3 * (y * image.width + side * kSide))]);
    }
    drawBar(image, most, barText);
    return image;
}

} // namespace serosa::app
