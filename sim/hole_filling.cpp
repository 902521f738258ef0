// See sim/hole_filling.h. W(i, j) is the weight of the best triangulation of the loop's vertices i .. j; its
// apex k makes the triangle (i, k, j).
#include "sim/hole_filling.h"

#include "base/check.h"
#include "sim/mesh_crossings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace serosa::sim {
namespace {

constexpr double kAngleStep = 1e-3; // rad: angles closer than this count as equal
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::uint64_t halfEdge(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t(from) << 32 | to;
}

struct Weight {
    double angle = 0; // the largest, in whole steps
    double area = 0;

    bool operator<(const Weight& other) const {
        return angle != other.angle ? angle < other.angle : area < other.area;
    }
};
constexpr Weight kNever{kInfinity, kInfinity};

glm::dvec3 crossOf(const TriangleMesh& mesh, const glm::uvec3& t) {
    const glm::dvec3& a = mesh.positions[t.x];
    return glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    return std::floor(angle / kAngleStep + 0.5);
}

} // namespace

HoleFiller::HoleFiller(TriangleMesh mesh)
    : mesh_(std::move(mesh)), originalFaces_(mesh_.faces.size()), tree_(mesh_.positions, mesh_.faces) {
    faceOf_.reserve(3 * mesh_.faces.size());
    for (std::uint32_t face = 0; face < originalFaces_; ++face)
        for (int corner = 0; corner < 3; ++corner)
            faceOf_[halfEdge(mesh_.faces[face][corner], mesh_.faces[face][(corner + 1) % 3])] = face;
}

bool HoleFiller::hasEdge(std::uint32_t a, std::uint32_t b) const {
    return faceOf_.contains(halfEdge(a, b)) || faceOf_.contains(halfEdge(b, a));
}

/// Of the face on the other side of a loop's edge; not of unit length.
glm::dvec3 HoleFiller::normalBeyond(std::uint32_t from, std::uint32_t to) const {
    return crossOf(mesh_, mesh_.faces[faceOf_.at(halfEdge(to, from))]);
}

std::optional<HoleFiller::Faces> HoleFiller::triangulate(const BoundaryLoop& loop, Aim aim) const {
    const std::size_t n = loop.size();
    std::vector<Weight> weights(n * n, kNever);
    std::vector<std::size_t> apex(n * n, 0);
    std::vector<glm::dvec3> normals(n * n); // of the triangle below the chord i j; of the mesh at an edge
    const auto at = [n](std::size_t i, std::size_t j) { return i * n + j; };
    for (std::size_t i = 0; i + 1 < n; ++i) {
        weights[at(i, i + 1)] = {};
        normals[at(i, i + 1)] = normalBeyond(loop[i], loop[i + 1]);
    }
    const glm::dvec3 last = normalBeyond(loop[n - 1], loop[0]);
    for (std::size_t width = 2; width < n; ++width)
        for (std::size_t i = 0; i + width < n; ++i) {
            const std::size_t j = i + width;
            const bool closing = width + 1 == n;
            if (!closing && hasEdge(loop[i], loop[j]))
                continue;
            for (std::size_t k = i + 1; k < j; ++k) {
                const Weight &left = weights[at(i, k)], &right = weights[at(k, j)];
                if (left.area == kInfinity || right.area == kInfinity)
                    continue;
                const glm::dvec3 normal = crossOf(mesh_, {loop[i], loop[k], loop[j]});
                if (normal == glm::dvec3(0))
                    continue;
                Weight weight{std::max(left.angle, right.angle),
                              left.area + right.area + glm::length(normal) / 2};
                if (aim == Aim::angle)
                    weight.angle = std::max({weight.angle, angleBetween(normal, normals[at(i, k)]),
                                             angleBetween(normal, normals[at(k, j)]),
                                             closing ? angleBetween(normal, last) : 0});
                if (weight < weights[at(i, j)]) {
                    weights[at(i, j)] = weight;
                    apex[at(i, j)] = k;
                    normals[at(i, j)] = normal;
                }
            }
        }
    if (weights[at(0, n - 1)].area == kInfinity)
        return {};
    Faces faces;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
    while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        if (j - i < 2)
            continue;
        const std::size_t k = apex[at(i, j)];
        faces.push_back({loop[i], loop[k], loop[j]});
        open.emplace_back(k, j);
        open.emplace_back(i, k);
    }
    return faces;
}

HoleFiller::Faces HoleFiller::fan(const BoundaryLoop& loop, std::uint32_t middle) const {
    Faces faces;
    for (std::size_t i = 0; i < loop.size(); ++i)
        faces.push_back({loop[i], loop[(i + 1) % loop.size()], middle});
    return faces;
}

/// No face without area, and none that touches another one beyond common corners and edges.
bool HoleFiller::fits(const Faces& faces) const {
    const auto meets = [&](const glm::uvec3& t, const glm::uvec3& u) {
        return facesMeet(mesh_.positions, t, u);
    };
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const glm::uvec3& t = faces[i];
        if (crossOf(mesh_, t) == glm::dvec3(0))
            return false;
        const glm::dvec3 &a = mesh_.positions[t.x], &b = mesh_.positions[t.y], &c = mesh_.positions[t.z];
        bool touches = false;
        tree_.overlapping(glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)),
                          [&](std::uint32_t face) { touches = touches || meets(t, mesh_.faces[face]); });
        for (std::size_t j = originalFaces_; j < mesh_.faces.size() && !touches; ++j)
            touches = meets(t, mesh_.faces[j]);
        for (std::size_t j = 0; j < i && !touches; ++j)
            touches = meets(t, faces[j]);
        if (touches)
            return false;
    }
    return true;
}

void HoleFiller::add(const Faces& faces) {
    for (const glm::uvec3& face : faces) {
        for (int corner = 0; corner < 3; ++corner)
            faceOf_[halfEdge(face[corner], face[(corner + 1) % 3])] = std::uint32_t(mesh_.faces.size());
        mesh_.faces.push_back(face);
    }
}

bool HoleFiller::fill(const BoundaryLoop& loop) {
    SEROSA_CHECK(loop.size() >= 3, "a hole has three edges or more");
    for (const Aim aim : {Aim::angle, Aim::area})
        if (const auto faces = triangulate(loop, aim); faces && fits(*faces)) {
            add(*faces);
            return true;
        }
    glm::dvec3 middle(0), colour(0);
    for (const std::uint32_t vertex : loop) {
        middle += mesh_.positions[vertex] / double(loop.size());
        if (!mesh_.colours.empty())
            colour += glm::dvec3(mesh_.colours[vertex]) / double(loop.size());
    }
    mesh_.positions.push_back(middle);
    const Faces faces = fan(loop, std::uint32_t(mesh_.positions.size() - 1));
    if (!fits(faces)) {
        mesh_.positions.pop_back();
        return false;
    }
    if (!mesh_.colours.empty())
        mesh_.colours.push_back(glm::u8vec3(glm::round(colour)));
    add(faces);
    return true;
}

} // namespace serosa::sim
