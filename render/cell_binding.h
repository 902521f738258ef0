#pragma once
// Trilinear embedding: a vertex keeps its coordinates in a cell of the lattice. The plainest way to carry a
// surface, to compare with: exact under any even deformation, but its normals jump between cells, and it
// fetches eight nodes.

#include "sim/lattice.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::render {

struct CellBinding {
    struct Vertex {
        std::uint32_t cell; // into `corners`
        glm::vec3 at;       // from the cell's lowest corner; 0 .. 1 inside
    };
    std::vector<Vertex> vertices;
    std::vector<std::array<std::uint32_t, 8>> corners; // nodes: at +x if c & 1, +y if c & 2, +z if c & 4
};

/// \param positions at rest, lattice units. A vertex outside of all material cells (by rounding, or where the
/// surface is another one than the lattice's) takes the closest cell near it, beyond whose faces it then
/// lies.
CellBinding bindToCells(const sim::Lattice& lattice, const std::vector<glm::dvec3>& positions);

} // namespace serosa::render
