// See render/deformation_texture.h.
#include "render/deformation_texture.h"

#include "render/parallel.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace serosa::render {

namespace {

constexpr double kMostTexels = 1 << 28;

template <class T>
void put(std::vector<std::uint8_t>& bytes, std::size_t index, T value) {
    std::memcpy(bytes.data() + index * sizeof(T), &value, sizeof(T));
}

std::size_t bytesOf(TexelFormat format) {
    return format == TexelFormat::unorm8 ? 4 : format == TexelFormat::half ? 8 : 16;
}

std::string where(std::size_t index, const glm::ivec3& size) {
    const std::size_t x = index % std::size_t(size.x), y = index / std::size_t(size.x) % std::size_t(size.y),
                      z = index / std::size_t(size.x) / std::size_t(size.y);
    return "texel (" + std::to_string(x) + ", " + std::to_string(y) + ", " + std::to_string(z) + ")";
}

} // namespace

Result<DeformationTexture> DeformationTexture::create(const glm::ivec3& size, const glm::dvec3& half,
                                                      TexelFormat format,
                                                      const std::vector<glm::dvec4>& texels) {
    if (size.x < 1 || size.y < 1 || size.z < 1)
        return Error{"a deformation texture of " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                     " x " + std::to_string(size.z) + " texels: take at least 1 along each axis"};
    if (double(size.x) * size.y * size.z > kMostTexels ||
        std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) != texels.size())
        return Error{"a deformation texture of " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                     " x " + std::to_string(size.z) + " texels does not hold " +
                     std::to_string(texels.size())};
    if (!(half.x > 0 && half.y > 0 && half.z > 0))
        return Error{"a deformation texture on a box without a size"};
    DeformationTexture made;
    made.size_ = size;
    made.half_ = half;
    made.format_ = format;
    double component = 0;
    bool anyKept = false;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const glm::dvec4& t = texels[i];
        if (!std::isfinite(t.x + t.y + t.z + t.w))
            return Error{where(i, size) + " of a deformation texture is no number"};
        const glm::dvec3 d(t);
        if (std::abs(d.x) > 2 * half.x || std::abs(d.y) > 2 * half.y || std::abs(d.z) > 2 * half.z)
            return Error{where(i, size) +
                         " of a deformation texture moves by more than its box is wide: take a "
                         "larger box, or less displacement"};
        component = std::max({component, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        made.largest_ = std::max(made.largest_, glm::length(d));
        made.cuts_ = made.cuts_ || t.w < 1;
        anyKept = anyKept || t.w >= 0.5;
    }
    if (!anyKept)
        return Error{"a deformation texture that cuts everything away: nothing would be drawn"};
    made.scale_ = component > 0 ? component : 1;
    const auto stored = std::make_shared<std::vector<std::uint8_t>>(texels.size() * bytesOf(format));
    made.stored_ = stored;
    made.texels_.resize(texels.size());
    parallelFor(texels.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (int c = 0; c < 4; ++c) {
                const double share = c < 3 ? texels[i][c] / made.scale_ : std::clamp(texels[i].w, 0.0, 1.0);
                double read = share;
                const std::size_t at = 4 * i + std::size_t(c);
                if (format == TexelFormat::unorm8) {
                    const int byte = int(std::lround(c < 3 ? 128 + 127 * share : 255 * share));
                    put(*stored, at, std::uint8_t(byte));
                    read = c < 3 ? (byte - 128) / 127.0 : byte / 255.0;
                } else if (format == TexelFormat::half) {
                    const std::uint16_t half16 = glm::packHalf1x16(float(share));
                    put(*stored, at, half16);
                    read = glm::unpackHalf1x16(half16);
                } else {
                    put(*stored, at, float(share));
                    read = float(share);
                }
                made.texels_[i][c] = float(c < 3 ? read * made.scale_ : read);
            }
    });
    return made;
}

Result<DeformationTexture> DeformationTexture::bake(const DeformationMap& map, const glm::ivec3& size,
                                                    TexelFormat format) {
    if (const std::string problem = problemOf(map); !problem.empty())
        return Error{std::string("a ") + nameOf(map.kind) + " deformation: " + problem};
    if (size.x < 1 || size.y < 1 || size.z < 1 || double(size.x) * size.y * size.z > kMostTexels)
        return create(size, map.half, format, {});
    std::vector<glm::dvec4> texels(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
    const glm::dvec3 step = 2.0 * map.half / glm::dvec3(size);
    // The coarsest axis that is sampled at all: no two samples that see other sides of a jump are mixed.
    double coarsest = 0;
    for (int axis = 0; axis < 3; ++axis)
        coarsest = std::max(coarsest, size[axis] > 1 ? step[axis] : 0.0);
    coarsest = coarsest > 0 ? coarsest : step.x;
    parallelFor(texels.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 at(double(i % std::size_t(size.x)),
                                double(i / std::size_t(size.x) % std::size_t(size.y)),
                                double(i / std::size_t(size.x) / std::size_t(size.y)));
            const glm::dvec3 q = (at + 0.5) * step - map.half;
            const double inside = kept(map, q, 1.5 * coarsest);
            texels[i] = glm::dvec4(inverseDisplacement(map, q),
                                   std::clamp(0.5 + inside / (kMaskBand * coarsest), 0.0, 1.0));
        }
    });
    return create(size, map.half, format, texels);
}

Result<DeformationTexture> DeformationTexture::sum(const DeformationTexture& a, const DeformationTexture& b) {
    if (a.size_ != b.size_ || a.half_ != b.half_)
        return Error{"deformation textures of other sizes or boxes cannot be added"};
    std::vector<glm::dvec4> texels(a.texels_.size());
    for (std::size_t i = 0; i < texels.size(); ++i) {
        texels[i] = glm::dvec4(a.texels_[i]) + glm::dvec4(b.texels_[i]);
        texels[i].w = std::min(a.texels_[i].w, b.texels_[i].w);
    }
    return create(a.size_, a.half_, std::max(a.format_, b.format_), texels);
}

std::size_t DeformationTexture::bytes() const {
    return stored_->size();
}

glm::dvec4 DeformationTexture::sample(const glm::dvec3& texture) const {
    const glm::dvec3 at = (texture + half_) / texelSize() - 0.5;
    const glm::dvec3 low = glm::floor(at), share = at - low;
    const glm::ivec3 cell(glm::clamp(low, glm::dvec3(-2), glm::dvec3(size_)));
    glm::dvec4 sum(0);
    for (int corner = 0; corner < 8; ++corner) {
        const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
        sum += (x ? share.x : 1 - share.x) * (y ? share.y : 1 - share.y) * (z ? share.z : 1 - share.z) *
               texel(cell.x + x, cell.y + y, cell.z + z);
    }
    return sum;
}

glm::dmat3 DeformationTexture::gradient(const glm::dvec3& texture) const {
    glm::dmat3 gradient(0);
    const glm::dvec3 step = texelSize();
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 by(0);
        by[axis] = 0.5 * step[axis];
        gradient[axis] = glm::dvec3(sample(texture + by) - sample(texture - by)) / step[axis];
    }
    return gradient;
}

glm::dvec3 DeformationTexture::maskGradient(const glm::dvec3& texture) const {
    glm::dvec3 gradient(0);
    const glm::dvec3 step = texelSize();
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 by(0);
        by[axis] = 0.5 * step[axis];
        gradient[axis] = (sample(texture + by).w - sample(texture - by).w) / step[axis];
    }
    return gradient;
}

Warp::Point Warp::at(const glm::dvec3& shown) const {
    if (!texture)
        return {shown, 1, false};
    const glm::dvec3 q = mapping.toTexture(shown), out = glm::abs(q) - texture->half();
    if (std::max({out.x, out.y, out.z}) > 0)
        return {shown, 1, false};
    const glm::dvec4 read = texture->sample(q);
    return {mapping.toObject(q + glm::dvec3(read)), read.w, true};
}

glm::dmat3 Warp::jacobian(const glm::dvec3& shown) const {
    if (!at(shown).inside)
        return glm::dmat3(1);
    const glm::dvec3 q = mapping.toTexture(shown);
    return mapping.jacobian(q + glm::dvec3(texture->sample(q))) * (glm::dmat3(1) + texture->gradient(q)) *
           glm::inverse(mapping.jacobian(q));
}

glm::dvec3 Warp::maskGradient(const glm::dvec3& shown) const {
    if (!at(shown).inside)
        return glm::dvec3(0);
    const glm::dvec3 q = mapping.toTexture(shown);
    return glm::transpose(glm::inverse(mapping.jacobian(q))) * texture->maskGradient(q);
}

} // namespace serosa::render
