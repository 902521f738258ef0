// See render/vertex_colours.h.
#include "render/vertex_colours.h"

#include "render/baked_occlusion.h"

#include <cmath>

namespace serosa::render {

namespace {

constexpr glm::u8vec3 kFlesh{158, 62, 54}; // sRGB of kFleshColour, where the mesh has no colours

/// Square root of the linear value: the vertex stage squares it, and 8 bits suffice in the dark.
std::uint8_t rootOfLinear(std::uint8_t srgb) {
    const double s = srgb / 255.0;
    const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    return std::uint8_t(std::lround(255 * std::sqrt(linear)));
}

glm::u8vec4 vertexColour(const glm::u8vec3& srgb, float open) {
    return {rootOfLinear(srgb.r), rootOfLinear(srgb.g), rootOfLinear(srgb.b), std::lround(255 * open)};
}

} // namespace

std::vector<glm::u8vec4> vertexColours(const sim::TriangleMesh& mesh, const glm::vec3* bare) {
    const std::vector<float> open = bakeOcclusion(mesh);
    std::vector<glm::u8vec4> colours;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        colours.push_back(vertexColour(mesh.colours.empty() ? kFlesh : mesh.colours[v], open[v]));
        for (int c = 0; c < 3 && bare && mesh.colours.empty(); ++c)
            colours.back()[c] = std::uint8_t(std::lround(255 * std::sqrt(double((*bare)[c]))));
    }
    return colours;
}

} // namespace serosa::render
