// See render/surface_seams.h. Tangents: the gradient of u over each face (Lengyel 2012, Mathematics for 3D
// Game Programming, 7.8), summed over the faces of a drawn vertex.
#include "render/surface_seams.h"

#include "base/check.h"

#include <map>
#include <numeric>
#include <tuple>

namespace serosa::render {

DrawnVertices drawnVertices(const sim::TriangleMesh& mesh, const std::vector<glm::dvec3>& normals) {
    DrawnVertices drawn;
    const std::size_t vertices = mesh.positions.size();
    drawn.origin.resize(vertices);
    std::iota(drawn.origin.begin(), drawn.origin.end(), 0U);
    if (mesh.uvs.empty()) {
        drawn.faces = mesh.faces;
        return drawn;
    }
    SEROSA_CHECK(mesh.uvs.size() == 3 * mesh.faces.size(), "three texture coordinates a face");
    std::vector<bool> taken(vertices, false);
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> known;
    drawn.textures.resize(vertices);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        glm::uvec3 face;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t v = mesh.faces[f][i];
            const glm::vec2 uv = mesh.uvs[3 * f + std::size_t(i)];
            const auto [found, fresh] =
                known.try_emplace({v, uv.x, uv.y}, taken[v] ? std::uint32_t(drawn.origin.size()) : v);
            if (fresh && taken[v]) {
                drawn.origin.push_back(v);
                drawn.textures.emplace_back();
            }
            taken[v] = true;
            drawn.textures[found->second].uv = uv;
            face[i] = found->second;
        }
        drawn.faces.push_back(face);
    }

    std::vector<glm::dvec3> along(drawn.origin.size(), glm::dvec3(0)), across = along;
    for (std::size_t f = 0; f < drawn.faces.size(); ++f) {
        const glm::uvec3 &face = drawn.faces[f], &corners = mesh.faces[f];
        const glm::dvec3 p = mesh.positions[corners.y] - mesh.positions[corners.x],
                         q = mesh.positions[corners.z] - mesh.positions[corners.x];
        const glm::dvec2 a = drawn.textures[face.y].uv - drawn.textures[face.x].uv,
                         b = drawn.textures[face.z].uv - drawn.textures[face.x].uv;
        const double area = a.x * b.y - a.y * b.x, sign = area < 0 ? -1 : 1;
        for (int i = 0; i < 3; ++i) {
            along[face[i]] += sign * (b.y * p - a.y * q);
            across[face[i]] += sign * (a.x * q - b.x * p);
        }
    }
    for (std::size_t i = 0; i < drawn.origin.size(); ++i) {
        const glm::dvec3 n = normals[drawn.origin[i]];
        glm::dvec3 t = along[i] - n * glm::dot(n, along[i]);
        if (glm::length(t) < 1e-12 * (1 + glm::length(along[i]))) // a texture that does not move along here
            t = glm::cross(n, std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
        t = glm::normalize(t);
        drawn.textures[i].tangent =
            glm::vec4(glm::vec3(t), glm::dot(glm::cross(n, t), across[i]) < 0 ? -1 : 1);
    }
    return drawn;
}

} // namespace serosa::render
