#include "render/baked_occlusion.h"

#include "render/parallel.h"
#include "sim/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace serosa::render {

namespace {

constexpr double kRange = 0.15;        // of the largest extent
constexpr double kLift = 0.002;        // of the largest extent, off the surface
constexpr std::size_t kRays = 400'000; // in all
constexpr std::size_t kMostRays = 32, kFewestRays = 4;
constexpr int kSmoothings = 2;

double radicalInverse(std::uint32_t i) {
    i = (i << 16) | (i >> 16);
    i = (i & 0x55555555U) << 1 | (i & 0xaaaaaaaaU) >> 1;
    i = (i & 0x33333333U) << 2 | (i & 0xccccccccU) >> 2;
    i = (i & 0x0f0f0f0fU) << 4 | (i & 0xf0f0f0f0U) >> 4;
    i = (i & 0x00ff00ffU) << 8 | (i & 0xff00ff00U) >> 8;
    return i * 0x1p-32;
}

/// Hammersley points lifted from the disc to the hemisphere about +z: density goes with the cosine.
std::vector<glm::dvec3> pattern(std::size_t rays) {
    std::vector<glm::dvec3> directions;
    for (std::size_t i = 0; i < rays; ++i) {
        const double radius2 = (double(i) + 0.5) / double(rays);
        const double angle = 2 * std::numbers::pi * radicalInverse(std::uint32_t(i));
        directions.emplace_back(std::sqrt(radius2) * std::cos(angle), std::sqrt(radius2) * std::sin(angle),
                                std::sqrt(1 - radius2));
    }
    return directions;
}

std::vector<float> averageOverNeighbours(const sim::TriangleMesh& mesh, const std::vector<float>& values) {
    std::vector<float> sum(values.size(), 0), count(values.size(), 0);
    for (const glm::uvec3& face : mesh.faces)
        for (int i = 0; i < 3; ++i) {
            sum[face[i]] += values[face[(i + 1) % 3]] + values[face[(i + 2) % 3]];
            count[face[i]] += 2;
        }
    for (std::size_t v = 0; v < values.size(); ++v)
        sum[v] = count[v] > 0 ? 0.5F * values[v] + 0.5F * sum[v] / count[v] : values[v];
    return sum;
}

} // namespace

std::vector<float> bakeOcclusion(const sim::TriangleMesh& mesh) {
    const glm::dvec3 extent = mesh.highest() - mesh.lowest();
    const double size = std::max({extent.x, extent.y, extent.z}), range = kRange * size;
    const std::size_t vertices = mesh.positions.size();
    if (vertices == 0 || size <= 0)
        return std::vector<float>(vertices, 1.0F);
    const std::vector<glm::dvec3> rays = pattern(std::clamp(kRays / vertices, kFewestRays, kMostRays));
    const std::vector<glm::dvec3> normals = mesh.vertexNormals();
    const sim::TriangleTree tree(mesh.positions, mesh.faces);

    std::vector<float> open(vertices);
    parallelFor(vertices, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const glm::dvec3 n = normals[v];
            const double turn = 2 * std::numbers::pi * radicalInverse(std::uint32_t(v) * 2654435761U);
            const glm::dvec3 any = std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
            const glm::dvec3 a = glm::normalize(glm::cross(n, any)), b = glm::cross(n, a);
            const glm::dvec3 t = std::cos(turn) * a + std::sin(turn) * b,
                             s = std::cos(turn) * b - std::sin(turn) * a;
            double taken = 0;
            for (const glm::dvec3& ray : rays) {
                const glm::dvec3 direction = ray.x * t + ray.y * s + ray.z * n;
                if (const auto hit = tree.firstHit(mesh.positions[v] + kLift * size * n, direction, range))
                    taken += (1 - hit->t / range) * (1 - hit->t / range);
            }
            open[v] = float(1 - taken / double(rays.size()));
        }
    });
    for (int i = 0; i < kSmoothings; ++i)
        open = averageOverNeighbours(mesh, open);
    return open;
}

} // namespace serosa::render
