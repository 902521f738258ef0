#pragma once
// What the vertex stage moves in the hybrid of CS07 section 6.3: tetrahedra that fill a box at rest and fit
// together. A grid of cubes, each cut into six along its diagonal (Kuhn 1960). Moved, a tetrahedron still has
// one straight way through it for each ray, and at rest that way is straight, too
// (shaders/raycast_proxy.glsl): what a map bends is followed to the second order of their size.

#include "gpu/program.h"

#include <glm/glm.hpp>

#include <vector>

namespace serosa::render {

class RayProxy {
public:
    RayProxy() = default;
    /// \param lowest, highest of the box, m. \param cells along its longest side, >= 1
    RayProxy(const glm::dvec3& lowest, const glm::dvec3& highest, int cells);

    explicit operator bool() const { return size_.x > 0; }
    const glm::ivec3& size() const { return size_; } // cells
    std::size_t tetrahedra() const { return indices_.bytes() / (4 * sizeof(unsigned)); }
    std::vector<glm::dvec3> corners() const; // m, at rest
    /// The same box and cells?
    bool is(const glm::dvec3& lowest, const glm::dvec3& highest, int cells) const {
        return lowest == lowest_ && highest == highest_ && cells == cells_;
    }

    /// Sets what shaders/raycast_proxy.vert asks for. \param origin, unit m: of the object space of the
    /// program
    void set(gpu::Program& program, const glm::dvec3& origin, double unit) const;
    /// Each tetrahedron once, as four corners.
    void draw() const;

private:
    glm::dvec3 lowest_{0}, highest_{0};
    int cells_ = 0;
    double step_ = 0; // m
    glm::ivec3 size_{0};
    gpu::Buffer indices_;
    gpu::VertexArray array_;
};

} // namespace serosa::render
