// See sim/cell_volumes.h.
#include "sim/cell_volumes.h"

#include <algorithm>

namespace serosa::sim {

std::vector<double> cellVolumeRatios(const Lattice& lattice, const LatticeState& state) {
    std::vector<double> ratios;
    ratios.reserve(lattice.cells.size());
    for (const LatticeCell& cell : lattice.cells) {
        glm::dmat3 gradient(0);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
            const glm::dvec3& x = state.positions[std::size_t(lattice.nodeAt(cell.grid + side))];
            for (int axis = 0; axis < 3; ++axis)
                gradient[axis] += x * (side[axis] ? 0.25 : -0.25);
        }
        ratios.push_back(glm::determinant(gradient));
    }
    return ratios;
}

std::size_t invertedCells(const Lattice& lattice, const LatticeState& state) {
    const std::vector<double> ratios = cellVolumeRatios(lattice, state);
    return std::size_t(std::count_if(ratios.begin(), ratios.end(), [](double ratio) { return ratio <= 0; }));
}

} // namespace serosa::sim
