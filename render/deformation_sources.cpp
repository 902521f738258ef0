// See render/deformation_sources.h.
#include "render/deformation_sources.h"

#include "render/parallel.h"

#include <algorithm>
#include <cmath>

namespace serosa::render {

namespace {

constexpr int kSteps = 60; // Newton's

glm::dvec3 texelMiddle(std::size_t index, const glm::ivec3& size, const glm::dvec3& half) {
    const glm::dvec3 at(double(index % std::size_t(size.x)),
                        double(index / std::size_t(size.x) % std::size_t(size.y)),
                        double(index / std::size_t(size.x) / std::size_t(size.y)));
    return (at + 0.5) * 2.0 * half / glm::dvec3(size) - half;
}

std::size_t countOf(const glm::ivec3& size) {
    return size.x < 1 || size.y < 1 || size.z < 1
               ? 0
               : std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

/// 1 in the box, 0 on its faces.
double fade(const glm::dvec3& q, const glm::dvec3& half) {
    double least = 1;
    for (int axis = 0; axis < 3; ++axis)
        least = std::min(least, (half[axis] - std::abs(q[axis])) / (0.2 * half[axis]));
    const double t = std::clamp(least, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

std::string textOf(const glm::dvec3& p) {
    return "(" + std::to_string(1e3 * p.x) + ", " + std::to_string(1e3 * p.y) + ", " +
           std::to_string(1e3 * p.z) + ") mm";
}

} // namespace

Result<DeformationTexture> interpolateControlPoints(const std::vector<ControlPoint>& points,
                                                    const glm::ivec3& size, const glm::dvec3& half,
                                                    double reach, TexelFormat format) {
    if (points.empty() || !(reach > 0))
        return Error{"a deformation by control points needs at least one of them, and a reach above 0"};
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (glm::any(glm::greaterThan(glm::abs(points[i].to), half)))
            return Error{"control point " + std::to_string(i + 1) + " was moved to " + textOf(points[i].to) +
                         ", outside of its box"};
        for (std::size_t j = 0; j < i; ++j)
            if (points[i].to == points[j].to)
                return Error{"control points " + std::to_string(j + 1) + " and " + std::to_string(i + 1) +
                             " were both moved to " + textOf(points[i].to)};
    }
    std::vector<glm::dvec4> texels(countOf(size));
    parallelFor(texels.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const glm::dvec3 q = texelMiddle(k, size, half);
            glm::dvec3 sum(0);
            double weights = 0;
            for (const ControlPoint& point : points) {
                const double d = std::max(glm::distance(q, point.to), 1e-12),
                             share = std::max(reach - d, 0.0) / (reach * d), w = share * share;
                // Nearest points count by their weight; far from all, D goes to nothing with the nearest.
                const double t = std::clamp(1 - d / reach, 0.0, 1.0), near = t * t * (3 - 2 * t);
                sum += w * near * (point.from - point.to);
                weights += w;
            }
            texels[k] = glm::dvec4(weights > 0 ? fade(q, half) * sum / weights : glm::dvec3(0), 1);
        }
    });
    return DeformationTexture::create(size, half, format, texels);
}

Result<InvertedDisplacement> invertDisplacement(const std::vector<glm::dvec3>& forward,
                                                const glm::ivec3& size, const glm::dvec3& half,
                                                TexelFormat format) {
    std::vector<glm::dvec4> texels(forward.size());
    for (std::size_t i = 0; i < forward.size(); ++i)
        texels[i] = glm::dvec4(forward[i], 1);
    SEROSA_ASSIGN(const DeformationTexture field,
                  DeformationTexture::create(size, half, TexelFormat::single, texels));
    const auto displaced = [&](const glm::dvec3& p) {
        return glm::any(glm::greaterThan(glm::abs(p), half)) ? glm::dvec3(0) : glm::dvec3(field.sample(p));
    };
    std::vector<double> residuals(texels.size());
    parallelFor(texels.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 shown = texelMiddle(i, size, half);
            glm::dvec3 p = shown - displaced(shown), miss = p + displaced(p) - shown;
            for (int step = 0; step < kSteps && glm::length(miss) > 1e-14; ++step) {
                const glm::dmat3 slope = glm::dmat3(1) + field.gradient(glm::clamp(p, -half, half));
                const double volume = glm::determinant(slope);
                bool fell = false;
                // The slope is that over a texel, the field bends within: where it misleads, straight back.
                for (const bool straight : {false, true}) {
                    const glm::dvec3 by =
                        !straight && std::abs(volume) > 1e-6 ? -(glm::inverse(slope) * miss) : -miss;
                    for (double share = 1; share > 0.01 && !fell; share *= 0.5) {
                        const glm::dvec3 next = p + share * by, left = next + displaced(next) - shown;
                        if (glm::length(left) < glm::length(miss)) {
                            p = next;
                            miss = left;
                            fell = true;
                        }
                    }
                }
                if (!fell)
                    break;
            }
            residuals[i] = glm::length(miss);
            texels[i] = glm::dvec4(p - shown, 1);
        }
    });
    InversionResidual residual;
    const glm::dvec3 texel = field.texelSize();
    const double enough = 0.01 * std::min({texel.x, texel.y, texel.z});
    for (const double one : residuals) {
        residual.largest = std::max(residual.largest, one);
        residual.unresolved += one > enough;
    }
    std::nth_element(residuals.begin(), residuals.begin() + std::ptrdiff_t(residuals.size() / 2),
                     residuals.end());
    residual.median = residuals[residuals.size() / 2];
    SEROSA_ASSIGN(DeformationTexture texture, DeformationTexture::create(size, half, format, texels));
    return InvertedDisplacement{std::move(texture), residual};
}

} // namespace serosa::render
