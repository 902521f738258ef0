// See sim/split_edges.h. Each sweep gives every long edge one middle, whichever faces it belongs to, and cuts
// each face into two, three or four by those that its edges have.
#include "sim/split_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace serosa::sim {

namespace {

class Split {
public:
    Split(TriangleMesh& mesh, double longest) : mesh_(mesh), longest_(longest) {}

    /// Returns whether anything was split.
    bool sweep() {
        middles_.clear();
        for (const glm::uvec3& face : mesh_.faces)
            for (int i = 0; i < 3; ++i)
                divide(face[i], face[(i + 1) % 3]);
        if (middles_.empty())
            return false;
        faces_.clear();
        uvs_.clear();
        for (std::size_t f = 0; f < mesh_.faces.size(); ++f)
            divideFace(f);
        mesh_.faces.swap(faces_);
        mesh_.uvs.swap(uvs_);
        return true;
    }

private:
    struct Corner {
        std::uint32_t vertex;
        glm::vec2 uv{0};
    };

    static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
        return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
    }
    double length(std::uint32_t a, std::uint32_t b) const {
        return glm::distance(mesh_.positions[a], mesh_.positions[b]);
    }

    void divide(std::uint32_t a, std::uint32_t b) {
        if (length(a, b) <= longest_)
            return;
        const auto [found, fresh] = middles_.try_emplace(key(a, b), std::uint32_t(mesh_.positions.size()));
        if (!fresh)
            return;
        mesh_.positions.push_back(0.5 * (mesh_.positions[a] + mesh_.positions[b]));
        if (!mesh_.colours.empty())
            mesh_.colours.push_back(
                glm::u8vec3((glm::uvec3(mesh_.colours[a]) + glm::uvec3(mesh_.colours[b]) + 1U) / 2U));
        const glm::dvec3 sum = mesh_.normals[a] + mesh_.normals[b];
        const double size = glm::length(sum);
        mesh_.normals.push_back(size > 0 ? sum / size : mesh_.normals[a]);
    }

    void emit(const Corner& a, const Corner& b, const Corner& c) {
        faces_.emplace_back(a.vertex, b.vertex, c.vertex);
        if (!mesh_.uvs.empty())
            uvs_.insert(uvs_.end(), {a.uv, b.uv, c.uv});
    }

    void divideFace(std::size_t f) {
        std::array<Corner, 3> corner, middle;
        std::array<bool, 3> split{};
        for (std::size_t i = 0; i < 3; ++i)
            corner[i] = {mesh_.faces[f][int(i)], mesh_.uvs.empty() ? glm::vec2(0) : mesh_.uvs[3 * f + i]};
        for (std::size_t i = 0; i < 3; ++i) {
            const Corner &a = corner[i], &b = corner[(i + 1) % 3];
            const auto found = middles_.find(key(a.vertex, b.vertex));
            split[i] = found != middles_.end();
            if (split[i])
                middle[i] = {found->second, 0.5F * (a.uv + b.uv)};
        }
        const auto count = std::count(split.begin(), split.end(), true);
        if (count == 0)
            return emit(corner[0], corner[1], corner[2]);
        if (count == 3) {
            for (std::size_t i = 0; i < 3; ++i)
                emit(corner[i], middle[i], middle[(i + 2) % 3]);
            return emit(middle[0], middle[1], middle[2]);
        }
        // Turned so that the first edge is the split one, or the third the one that is not.
        std::size_t turn = 0;
        while (count == 1 ? !split[turn] : split[(turn + 2) % 3])
            ++turn;
        const auto at = [turn](const auto& three, std::size_t i) { return three[(turn + i) % 3]; };
        const Corner a = at(corner, 0), b = at(corner, 1), c = at(corner, 2), ab = at(middle, 0);
        if (count == 1) {
            emit(a, ab, c);
            return emit(ab, b, c);
        }
        const Corner bc = at(middle, 1);
        emit(ab, b, bc);
        if (length(a.vertex, bc.vertex) < length(ab.vertex, c.vertex)) {
            emit(a, ab, bc);
            emit(a, bc, c);
        } else {
            emit(a, ab, c);
            emit(ab, bc, c);
        }
    }

    TriangleMesh& mesh_;
    double longest_;
    std::unordered_map<std::uint64_t, std::uint32_t> middles_; // by edge
    std::vector<glm::uvec3> faces_;
    std::vector<glm::vec2> uvs_;
};

} // namespace

bool splitLongEdges(TriangleMesh& mesh, double longest) {
    const bool any = std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const glm::uvec3& face) {
        for (int i = 0; i < 3; ++i)
            if (glm::distance(mesh.positions[face[i]], mesh.positions[face[(i + 1) % 3]]) > longest)
                return true;
        return false;
    });
    if (!any)
        return false;
    mesh.normals = mesh.vertexNormals();
    Split split(mesh, longest);
    while (split.sweep()) {
    }
    return true;
}

} // namespace serosa::sim
