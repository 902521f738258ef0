// Beam and ball: the two phantoms whose shape is known exactly.
#include "models/simple_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace serosa::models {
namespace {

const glm::u8vec3 kBeamColour(196, 120, 108), kBallColour(178, 84, 78);

} // namespace

sim::TriangleMesh makeGridBox(const glm::dvec3& extent, const glm::ivec3& cells) {
    sim::TriangleMesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> known;
    const auto vertex = [&](const glm::ivec3& g) {
        const auto [entry, isNew] =
            known.try_emplace({g.x, g.y, g.z}, static_cast<std::uint32_t>(mesh.positions.size()));
        if (isNew) {
            mesh.positions.push_back((glm::dvec3(g) / glm::dvec3(cells) - 0.5) * extent);
            mesh.colours.push_back(kBeamColour);
        }
        return entry->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (int i = 0; i < cells[u]; ++i)
                for (int j = 0; j < cells[v]; ++j) {
                    glm::ivec3 corner(0), du(0), dv(0);
                    corner[axis] = side * cells[axis];
                    corner[u] = i;
                    corner[v] = j;
                    du[u] = dv[v] = 1;
                    const std::uint32_t a = vertex(corner), b = vertex(corner + du),
                                        c = vertex(corner + du + dv), d = vertex(corner + dv);
                    // Diagonals alternate, so that a bend shows no grain.
                    if ((i + j) % 2 == 0) {
                        mesh.faces.push_back(side ? glm::uvec3(a, b, c) : glm::uvec3(a, c, b));
                        mesh.faces.push_back(side ? glm::uvec3(a, c, d) : glm::uvec3(a, d, c));
                    } else {
                        mesh.faces.push_back(side ? glm::uvec3(a, b, d) : glm::uvec3(a, d, b));
                        mesh.faces.push_back(side ? glm::uvec3(b, c, d) : glm::uvec3(b, d, c));
                    }
                }
        }
    return mesh;
}

Result<sim::TriangleMesh> makeBeam(std::size_t faces) {
    if (faces > 4000000)
        return Error{"the beam phantom has at most 4000000 faces, not " + std::to_string(faces)};
    // a x b x c cells have 4 (ab + bc + ca) faces. The smallest count that is enough wins, then the squarest
    // cells.
    const glm::dvec3 extent(30, 30, 120);
    glm::ivec3 best(0);
    double bestScore = 1e300;
    const double square = std::sqrt(std::max(1.0, static_cast<double>(faces)) / 36);
    for (int a = std::max(1, static_cast<int>(square * 0.7)); a <= static_cast<int>(square * 1.4) + 2; ++a)
        for (int b = std::max(1, a - 3); b <= a + 3; ++b) {
            const double need = static_cast<double>(faces) / 4 - static_cast<double>(a) * b;
            const int c = std::max(1, static_cast<int>(std::ceil(need / (a + b))));
            const double count = 4.0 * (static_cast<double>(a) * b + static_cast<double>(c) * (a + b));
            if (count > 1.05 * static_cast<double>(std::max<std::size_t>(faces, 12)))
                continue;
            const double shape = std::log(120.0 * a / (30.0 * c)),
                         shape2 = std::log(static_cast<double>(a) / b);
            const double score = shape * shape + shape2 * shape2;
            if (score < bestScore) {
                bestScore = score;
                best = {a, b, c};
            }
        }
    if (bestScore == 1e300)
        return Error{"the beam phantom cannot have between " + std::to_string(faces) +
                     " and 5% more faces; ask for 12 or for more than 100"};
    return makeGridBox(extent, best);
}

Result<sim::TriangleMesh> makeLayer(std::size_t faces) {
    const int n =
        std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(faces) / 180) - 1e-9)));
    const std::size_t count = 180 * static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    if (n > 150 || static_cast<double>(count) > 1.05 * static_cast<double>(std::max<std::size_t>(faces, 180)))
        return Error{"the layer phantom has 180 n^2 faces; " + std::to_string(faces) +
                     " is not within 5% below one: ask for " + std::to_string(count)};
    return makeGridBox({120, 48, 120}, n * glm::ivec3(5, 2, 5));
}

Result<sim::TriangleMesh> makeBall(std::size_t faces) {
    // An icosahedron whose faces are cut into n x n: 20 n^2 faces.
    const int n = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(faces) / 20) - 1e-9)));
    const std::size_t count = 20 * static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    if (n > 400 || static_cast<double>(count) > 1.05 * static_cast<double>(std::max<std::size_t>(faces, 20)))
        return Error{"the ball phantom has 20 n^2 faces; " + std::to_string(faces) +
                     " is not within 5% below one: ask for " + std::to_string(count)};
    const double g = (1 + std::sqrt(5.0)) / 2;
    const glm::dvec3 corners[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                    {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                    {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    const int triangles[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                  {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                  {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                  {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    sim::TriangleMesh mesh;
    // A vertex is known by its whole-number weights on the icosahedron's corners.
    std::map<std::array<std::array<int, 2>, 3>, std::uint32_t> known;
    for (const auto& t : triangles) {
        const auto vertex = [&](int i, int j) {
            const int weights[3] = {n - i - j, i, j};
            std::array<std::array<int, 2>, 3> key{};
            for (int k = 0; k < 3; ++k)
                key[static_cast<std::size_t>(k)] =
                    weights[k] ? std::array<int, 2>{t[k], weights[k]} : std::array<int, 2>{-1, 0};
            std::sort(key.begin(), key.end());
            const auto [entry, isNew] =
                known.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
            if (isNew) {
                glm::dvec3 p(0);
                for (const auto& [corner, weight] : key)
                    if (weight)
                        p += static_cast<double>(weight) * corners[corner];
                mesh.positions.push_back(kBallRadius * glm::normalize(p));
                mesh.colours.push_back(kBallColour);
            }
            return entry->second;
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                mesh.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
                if (i + j + 1 < n)
                    mesh.faces.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
            }
    }
    return mesh;
}

} // namespace serosa::models
