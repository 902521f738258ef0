// See render/ray_proxy.h.
#include "render/ray_proxy.h"

#include <algorithm>
#include <array>

namespace serosa::render {

namespace {

/// Each runs from corner 0 to corner 7 along the axes in one order. All have the same orientation.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

} // namespace

RayProxy::RayProxy(const glm::dvec3& lowest, const glm::dvec3& highest, int cells)
    : lowest_(lowest), highest_(highest), cells_(cells) {
    const glm::dvec3 extent = highest - lowest;
    step_ = std::max({extent.x, extent.y, extent.z}) / cells;
    size_ = glm::max(glm::ivec3(glm::ceil(extent / step_ - 1e-9)), 1);
    std::vector<unsigned> indices;
    for (int z = 0; z < size_.z; ++z)
        for (int y = 0; y < size_.y; ++y)
            for (int x = 0; x < size_.x; ++x)
                for (const auto& tetrahedron : kTetrahedra)
                    for (const int corner : tetrahedron)
                        indices.push_back(unsigned(
                            x + (corner & 1) +
                            (size_.x + 1) * (y + (corner >> 1 & 1) + (size_.y + 1) * (z + (corner >> 2)))));
    indices_ = gpu::Buffer("tetrahedra of a ray caster", std::span<const unsigned>(indices));
    array_ = gpu::VertexArray("tetrahedra of a ray caster");
    array_.indices(indices_);
}

std::vector<glm::dvec3> RayProxy::corners() const {
    std::vector<glm::dvec3> all;
    for (int z = 0; z <= size_.z; ++z)
        for (int y = 0; y <= size_.y; ++y)
            for (int x = 0; x <= size_.x; ++x)
                all.push_back(lowest_ + step_ * glm::dvec3(x, y, z));
    return all;
}

void RayProxy::set(gpu::Program& program, const glm::dvec3& origin, double unit) const {
    program.set("u_proxyLowest", glm::vec3((lowest_ - origin) / unit));
    program.set("u_proxyStep", float(step_ / unit)).set("u_proxyCorners", size_ + 1);
}

void RayProxy::draw() const {
    glBindVertexArray(array_.id());
    glDrawElements(GL_LINES_ADJACENCY, GLsizei(indices_.bytes() / sizeof(unsigned)), GL_UNSIGNED_INT,
                   nullptr);
}

} // namespace serosa::render
