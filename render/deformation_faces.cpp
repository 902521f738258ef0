// See render/deformation_faces.h.
#include "render/deformation_faces.h"

#include <algorithm>
#include <cstdio>
#include <numbers>

namespace serosa::render {

namespace {

constexpr int kLeastSamples = 24, kMostSamples = 128; // along a side of a face: one a texel
constexpr double kStill = 0.1;                        // texels

double coarsest(const DeformationTexture& texture) {
    const glm::dvec3 texel = texture.texelSize();
    double most = 0;
    for (int axis = 0; axis < 3; ++axis)
        most = std::max(most, texture.size()[axis] > 1 ? texel[axis] : 0.0);
    return most > 0 ? most : std::min({texel.x, texel.y, texel.z});
}

std::string placeText(const glm::dvec3& at) {
    char text[80];
    std::snprintf(text, sizeof text, " at (%.3g, %.3g, %.3g) mm", 1e3 * at.x, 1e3 * at.y, 1e3 * at.z);
    return text;
}

/// "+y ..., -z ...": of those that are meant, what `say` says.
template <class Say>
std::string facesText(const std::array<FaceOfBox, 6>& faces, bool FaceOfBox::*meant, const Say& say) {
    static const char* const kNames[] = {"-x", "+x", "-y", "+y", "-z", "+z"};
    std::string text;
    for (std::size_t i = 0; i < 6; ++i)
        if (faces[i].*meant)
            text += (text.empty() ? "" : ", ") + (kNames[i] + say(faces[i]));
    return text;
}

/// The ends of a box that is wound once around meet.
bool meetsItself(const Warp& warp) {
    return warp.mapping.cylinderRadius > 0 &&
           warp.texture->half().z >= 0.999 * std::numbers::pi * warp.mapping.cylinderRadius;
}

} // namespace

std::array<FaceOfBox, 6> examineFaces(const Warp& warp,
                                      const std::function<bool(const glm::dvec3&)>& inside) {
    std::array<FaceOfBox, 6> faces;
    const glm::dvec3& half = warp.texture->half();
    const double enough = kStill * coarsest(*warp.texture);
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        if (axis == 2 && meetsItself(warp))
            continue;
        FaceOfBox& one = faces[std::size_t(face)];
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const glm::ivec3 count = glm::clamp(warp.texture->size(), kLeastSamples, kMostSamples);
        for (int i = 0; i < count[u] * count[v]; ++i) {
            glm::dvec3 q;
            q[axis] = (face % 2 == 0 ? -1 : 1) * (1 - 1e-9) * half[axis];
            q[u] = (2 * (i % count[u] + 0.5) / count[u] - 1) * half[u];
            q[v] = (2 * (i / count[u] + 0.5) / count[v] - 1) * half[v];
            const glm::dvec4 read = warp.texture->sample(q);
            const double moved = glm::length(glm::dvec3(read));
            const bool cut = read.w < 0.5;
            if (!(moved > enough || cut))
                continue;
            one.still = false;
            const glm::dvec3 shown = warp.mapping.toObject(q);
            if (!one.ends && !cut && moved > enough && inside(warp.mapping.toObject(q + glm::dvec3(read)))) {
                one.ends = true;
                one.endsAt = shown;
            }
            if ((one.tears && moved <= one.moved) || !inside(shown))
                continue;
            one.tears = true;
            one.moved = moved;
            one.at = shown;
        }
    }
    return faces;
}

std::string tornFaces(const std::array<FaceOfBox, 6>& faces) {
    return facesText(faces, &FaceOfBox::tears, [](const FaceOfBox& face) {
        char by[40];
        std::snprintf(by, sizeof by, " by %.3g mm", 1e3 * face.moved);
        return by + placeText(face.at);
    });
}

std::string endingFaces(const std::array<FaceOfBox, 6>& faces) {
    return facesText(faces, &FaceOfBox::ends, [](const FaceOfBox& face) { return placeText(face.endsAt); });
}

double foldedShare(const DeformationTexture& texture) {
    std::size_t folded = 0, all = 0;
    const glm::ivec3& size = texture.size();
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const glm::dvec3 q = (glm::dvec3(x, y, z) + 0.5) * texture.texelSize() - texture.half();
                if (texture.sample(q).w < 1) // beside a cut D jumps
                    continue;
                ++all;
                folded += glm::determinant(glm::dmat3(1) + texture.gradient(q)) <= 0;
            }
    return all > 0 ? double(folded) / double(all) : 0;
}

} // namespace serosa::render
