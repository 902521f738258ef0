// Van Oosterom & Strackee 1983, The solid angle of a plane triangle, equation 8.
#include "sim/mesh_nesting.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {
namespace {

struct Bounds {
    glm::dvec3 lowest, highest;
    bool contain(const glm::dvec3& p) const {
        return glm::all(glm::greaterThanEqual(p, lowest)) && glm::all(glm::lessThanEqual(p, highest));
    }
};

Bounds boundsOf(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces) {
    const glm::dvec3 first = mesh.positions[mesh.faces[faces.front()].x];
    Bounds bounds{first, first};
    for (const std::uint32_t face : faces)
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3& p = mesh.positions[mesh.faces[face][corner]];
            bounds.lowest = glm::min(bounds.lowest, p);
            bounds.highest = glm::max(bounds.highest, p);
        }
    return bounds;
}

double volumeOf(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces) {
    const glm::dvec3 origin = mesh.positions[mesh.faces[faces.front()].x];
    double sum = 0;
    for (const std::uint32_t face : faces) {
        const glm::uvec3 t = mesh.faces[face];
        sum += glm::dot(mesh.positions[t.x] - origin,
                        glm::cross(mesh.positions[t.y] - origin, mesh.positions[t.z] - origin));
    }
    return sum / 6;
}

} // namespace

double windingNumber(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces, const glm::dvec3& p) {
    double turns = 0;
    for (const std::uint32_t face : faces) {
        const glm::uvec3 t = mesh.faces[face];
        const glm::dvec3 a = mesh.positions[t.x] - p, b = mesh.positions[t.y] - p,
                         c = mesh.positions[t.z] - p;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        turns += std::atan2(glm::dot(a, glm::cross(b, c)),
                            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return turns / (2 * M_PI); // atan2 gave half the solid angle; a full turn is 4 pi
}

std::vector<Shell> findNesting(const TriangleMesh& mesh,
                               const std::vector<std::vector<std::uint32_t>>& shellFaces) {
    constexpr std::size_t kVotes = 9;
    std::vector<Shell> shells(shellFaces.size());
    std::vector<Bounds> bounds;
    for (std::size_t i = 0; i < shells.size(); ++i) {
        shells[i].volume = volumeOf(mesh, shellFaces[i]);
        bounds.push_back(boundsOf(mesh, shellFaces[i]));
    }
    for (std::size_t inner = 0; inner < shells.size(); ++inner) {
        const auto& faces = shellFaces[inner];
        const std::size_t votes = std::min(kVotes, faces.size());
        for (std::size_t outer = 0; outer < shells.size(); ++outer) {
            if (outer == inner)
                continue;
            std::size_t inside = 0;
            for (std::size_t vote = 0; vote < votes; ++vote) {
                const glm::dvec3& p = mesh.positions[mesh.faces[faces[vote * faces.size() / votes]].x];
                if (bounds[outer].contain(p) && std::abs(windingNumber(mesh, shellFaces[outer], p)) > 0.5)
                    ++inside;
            }
            if (2 * inside > votes)
                ++shells[inner].depth;
        }
    }
    return shells;
}

} // namespace serosa::sim
