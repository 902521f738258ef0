#pragma once
// Noise that repeats: gradient noise (Perlin 2002, Improving Noise) and cells (Worley 1996, A Cellular
// Texture Basis Function) over a torus, from integer hashes.

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>

namespace serosa::render {

/// 32 well mixed bits of two coordinates (the finalizer of MurmurHash3).
inline std::uint32_t hashOf(int x, int y, std::uint32_t seed) {
    std::uint32_t h = std::uint32_t(x) * 0x9e3779b1U ^ std::uint32_t(y) * 0x85ebca77U ^ seed * 0xc2b2ae3dU;
    h ^= h >> 16;
    h *= 0x85ebca6bU;
    h ^= h >> 13;
    h *= 0xc2b2ae35U;
    return h ^ h >> 16;
}
inline double unitOf(std::uint32_t h) {
    return h * 0x1p-32;
}
inline int wrapped(int i, int period) {
    return (i % period + period) % period;
}

/// -1..1, zero at whole numbers. \param period of x and y, whole numbers
inline double gradientNoise(const glm::dvec2& at, const glm::ivec2& period, std::uint32_t seed) {
    const glm::ivec2 cell = glm::ivec2(glm::floor(at));
    const glm::dvec2 f = at - glm::dvec2(cell);
    const auto corner = [&](int dx, int dy) {
        const double turn = 6.283185307179586 * unitOf(hashOf(wrapped(cell.x + dx, period.x),
                                                              wrapped(cell.y + dy, period.y), seed));
        return std::cos(turn) * (f.x - dx) + std::sin(turn) * (f.y - dy);
    };
    const glm::dvec2 s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    return 1.5 * glm::mix(glm::mix(corner(0, 0), corner(1, 0), s.x),
                          glm::mix(corner(0, 1), corner(1, 1), s.x), s.y);
}

/// Octaves of it, each of twice the frequency and half the height.
inline double layeredNoise(const glm::dvec2& at, const glm::ivec2& period, int octaves, std::uint32_t seed) {
    double sum = 0, weight = 1, scale = 1;
    for (int i = 0; i < octaves; ++i, weight *= 0.5, scale *= 2)
        sum += weight * gradientNoise(at * scale, period * int(scale), seed + std::uint32_t(i));
    return sum / (2 - 2 * weight);
}

/// Distances to the nearest and the next of one point a cell, in cells.
struct CellDistances {
    double nearest = 8, next = 8;
    std::uint32_t id = 0; // of the nearest
};
inline CellDistances cellNoise(const glm::dvec2& at, const glm::ivec2& period, std::uint32_t seed) {
    const glm::ivec2 cell = glm::ivec2(glm::floor(at));
    CellDistances found;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const std::uint32_t h =
                hashOf(wrapped(cell.x + dx, period.x), wrapped(cell.y + dy, period.y), seed);
            const glm::dvec2 point(cell.x + dx + 0.1 + 0.8 * unitOf(h),
                                   cell.y + dy + 0.1 + 0.8 * unitOf(h * 0x9e3779b1U));
            const double d = glm::distance(at, point);
            if (d < found.nearest) {
                found.next = found.nearest;
                found.nearest = d;
                found.id = h;
            } else if (d < found.next) {
                found.next = d;
            }
        }
    return found;
}

} // namespace serosa::render
