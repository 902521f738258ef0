// See sim/displacement.h. Displacements are differences in lattice units, taken before anything is scaled or
// moved: an organ metres from the origin loses nothing.
#include "sim/displacement.h"

#include "sim/byte_stream.h"

namespace serosa::sim {

namespace {
constexpr double kMillimetres = 1e3; // in a metre

glm::dvec3 movedBy(const Lattice& lattice, const LatticeState& state, std::size_t node) {
    return kMillimetres * lattice.spacing * (state.positions[node] - lattice.restPosition(node));
}
} // namespace

DisplacementGrid displacementGrid(const Lattice& lattice, const LatticeState& state) {
    DisplacementGrid grid;
    grid.size = lattice.nodeDims;
    grid.spacing = kMillimetres * lattice.spacing;
    grid.origin = kMillimetres * lattice.toWorld(-glm::dvec3(lattice.centre));
    grid.vectors.assign(lattice.nodeOfGrid.size(), glm::vec3(0));
    grid.hasNode.assign(lattice.nodeOfGrid.size(), 0);
    for (std::size_t place = 0; place < lattice.nodeOfGrid.size(); ++place)
        if (const std::int32_t node = lattice.nodeOfGrid[place]; node >= 0) {
            grid.vectors[place] = glm::vec3(movedBy(lattice, state, std::size_t(node)));
            grid.hasNode[place] = 1;
        }
    return grid;
}

std::string displacementPly(const Lattice& lattice, const LatticeState& state) {
    ByteWriter out;
    out.raw("ply\nformat binary_little_endian 1.0\n"
            "comment nodes of a lattice: rest position and displacement from it, mm, world frame, y up\n"
            "element vertex " +
            std::to_string(lattice.nodeCount()) + "\n");
    for (const char* name : {"x", "y", "z", "dx", "dy", "dz"})
        out.raw(std::string("property double ") + name + "\n");
    out.raw("end_header\n");
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const glm::dvec3 rest = kMillimetres * lattice.toWorld(lattice.restPosition(node));
        for (const glm::dvec3& vector : {rest, movedBy(lattice, state, node)})
            for (int axis = 0; axis < 3; ++axis)
                out.f64(vector[axis]);
    }
    return out.take();
}

} // namespace serosa::sim
