// See sim/cell_volumes.h.
#include "sim/cell_volumes.h"

#include "shaders/shared_constants.h"

#include <algorithm>

namespace serosa::sim {

CellCorners cornersOf(const Lattice& lattice, const LatticeCell& cell) {
    CellCorners corners;
    for (int c = 0; c < 8; ++c)
        corners[std::size_t(c)] = std::uint32_t(lattice.nodeAt(cell.grid + cornerOffset(c)));
    return corners;
}

std::uint32_t directionsInCell(int corner) {
    std::uint32_t mask = 0;
    for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
            const int step = kNeighbourOffsets[std::size_t(d)][axis];
            inside = inside && (step == 0 || (step < 0) == (((corner >> axis) & 1) != 0));
        }
        mask |= inside ? 1u << d : 0u;
    }
    return mask;
}

glm::dmat3 meanGradient(const CellCorners& corners, const std::vector<glm::dvec3>& x) {
    glm::dmat3 gradient(0);
    for (int c = 0; c < 8; ++c)
        for (int axis = 0; axis < 3; ++axis)
            gradient[axis] += 0.25 * cornerSign(c)[axis] * x[corners[std::size_t(c)]];
    return gradient;
}

std::vector<double> cellVolumeRatios(const Lattice& lattice, const LatticeState& state) {
    std::vector<double> ratios;
    ratios.reserve(lattice.cells.size());
    for (const LatticeCell& cell : lattice.cells)
        ratios.push_back(glm::determinant(meanGradient(cornersOf(lattice, cell), state.positions)));
    return ratios;
}

std::size_t invertedCells(const Lattice& lattice, const LatticeState& state) {
    const std::vector<double> ratios = cellVolumeRatios(lattice, state);
    return std::size_t(std::count_if(ratios.begin(), ratios.end(), [](double ratio) { return ratio <= 0; }));
}

} // namespace serosa::sim
