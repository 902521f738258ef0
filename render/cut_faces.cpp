// See render/cut_faces.h.
#include "render/cut_faces.h"

#include "sim/pieces.h"

#include <array>

namespace serosa::render {

namespace {

/// Were two nodes joined before anything was cut, and are they no longer?
bool parted(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections, std::uint32_t a,
            std::uint32_t b) {
    const glm::ivec3 offset = lattice.nodes[b] - lattice.nodes[a];
    for (std::size_t d = 0; d < sim::kNeighbourOffsets.size(); ++d)
        if (sim::kNeighbourOffsets[d] == offset)
            return ((lattice.connections[a] & ~connections[a]) >> d) & 1U;
    return false;
}

} // namespace

std::vector<bool> facesLeft(const sim::Lattice& lattice, const std::vector<glm::uvec3>& faces,
                            const SurfaceBinding& binding, const std::vector<std::uint32_t>& connections) {
    const std::vector<std::uint32_t> labels = sim::pieceLabels(lattice, connections);
    std::vector<bool> left(faces.size(), true);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        std::array<std::uint32_t, 9> nodes{};
        bool touched = false;
        for (int i = 0; i < 9; ++i) {
            const std::uint32_t node = binding.vertices[faces[f][i / 3]].nodes[i % 3];
            nodes[std::size_t(i)] = node;
            touched = touched || connections[node] != lattice.connections[node];
        }
        for (std::size_t i = 0; i < 9 && left[f]; ++i)
            for (std::size_t j = 0; j < i && left[f]; ++j)
                left[f] =
                    labels[nodes[i]] == labels[nodes[j]] &&
                    !(touched && nodes[i] != nodes[j] && parted(lattice, connections, nodes[i], nodes[j]));
    }
    return left;
}

} // namespace serosa::render
