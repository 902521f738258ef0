// See render/cut_faces.h.
#include "render/cut_faces.h"

#include "render/cut_sides.h"
#include "sim/pieces.h"

#include <vector>

namespace serosa::render {

namespace {

/// The nodes that a vertex follows.
void addNodes(const SurfaceBinding& binding, std::uint32_t vertex, std::vector<std::uint32_t>& nodes) {
    if (binding.mapping == sim::Mapping::trilinear)
        for (const std::uint32_t node : binding.cells.corners[binding.cells.vertices[vertex].cell])
            nodes.push_back(node);
    else
        for (int i = 0; i < 3; ++i)
            nodes.push_back(binding.vertices[vertex].nodes[i]);
}

} // namespace

std::vector<bool> facesLeft(const sim::Lattice& lattice, const std::vector<glm::uvec3>& faces,
                            const SurfaceBinding& binding, const std::vector<std::uint32_t>& connections) {
    const std::vector<std::uint32_t> labels = sim::pieceLabels(lattice, connections);
    CutSides sides(lattice, connections);
    std::vector<bool> left(faces.size(), true);
    std::vector<std::uint32_t> nodes;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        nodes.clear();
        for (int i = 0; i < 3; ++i)
            addNodes(binding, faces[f][i], nodes);
        bool touched = false;
        for (const std::uint32_t node : nodes)
            touched = touched || sides.isNear(node);
        for (std::size_t i = 0; i < nodes.size() && left[f]; ++i)
            for (std::size_t j = 0; j < i && left[f]; ++j)
                left[f] =
                    labels[nodes[i]] == labels[nodes[j]] &&
                    (!touched || (!sides.parted(nodes[i], nodes[j]) && !sides.separated(nodes[i], nodes[j])));
    }
    return left;
}

} // namespace serosa::render
