// See sim/stiffening.h. Twin of the GPU's pass, shaders/cell_stiffening.glsl.
#include "sim/stiffening.h"

#include "shaders/shared_constants.h"
#include "sim/pieces.h"
#include "sim/volume_term.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

/// Corner of a cell's corner c's neighbour in direction d.
int cornerBeside(int c, int d) {
    int corner = 0;
    for (int axis = 0; axis < 3; ++axis)
        corner |= (((c >> axis) & 1) + kNeighbourOffsets[std::size_t(d)][axis]) << axis;
    return corner;
}

} // namespace

Stiffening::Stiffening(const Lattice& lattice, const Tissue& tissue,
                       const std::vector<std::uint32_t>& connections) {
    SEROSA_CHECK(connections.size() == lattice.nodeCount(), "connections of this lattice");
    if (!tissue.stiffens())
        return;
    materials_ = materialShares(tissue);
    const std::vector<bool> whole = wholeCells(lattice, connections);
    for (std::size_t i = 0; i < lattice.cells.size(); ++i) {
        const LatticeCell& cell = lattice.cells[i];
        Cell added{cornersOf(lattice, cell), {}, cell.fill / 255.0, whole[i], cell.material};
        for (int c = 0; c < 8; ++c)
            added.bits[std::size_t(c)] = connections[added.corners[std::size_t(c)]] & directionsInCell(c);
        cells_.push_back(added);
    }
}

double Stiffening::linearEnergy(const Cell& cell, const std::vector<glm::dvec3>& positions) const {
    const MaterialShares& material = materials_[cell.material];
    double energy = 0;
    for (int c = 0; c < 8; ++c)
        for (int d = 0; d < SRS_NEIGHBOURS; d += 2) { // each spring at one of its ends
            if (!((cell.bits[std::size_t(c)] >> d) & 1u))
                continue;
            const glm::dvec3& a = positions[cell.corners[std::size_t(c)]];
            const glm::dvec3& b = positions[cell.corners[std::size_t(cornerBeside(c, d))]];
            const double stretch = glm::distance(a, b) - (d < 6 ? 1.0 : std::sqrt(2.0));
            energy += 0.5 * (d < 6 ? 0.25 : 0.5) * material.spring[std::size_t(d / 2)] * stretch * stretch;
        }
    if (cell.whole)
        energy += volumeEnergy(meanGradient(cell.corners, positions), material.bulk, 0);
    return cell.fill * energy;
}

double Stiffening::tensionStrain(const Cell& cell, const std::vector<glm::dvec3>& positions) const {
    const MaterialShares& material = materials_[cell.material];
    return material.tensionStrain(2 * linearEnergy(cell, positions) / (cell.fill * material.young));
}

std::vector<double> Stiffening::factors(const std::vector<glm::dvec3>& positions) const {
    std::vector<double> factors;
    factors.reserve(cells_.size());
    for (const Cell& cell : cells_) {
        const MaterialShares& material = materials_[cell.material];
        factors.push_back(material.breaks.empty() ? 1.0
                                                  : material.stiffening(tensionStrain(cell, positions)));
    }
    return factors;
}

std::vector<double> Stiffening::tangents(const std::vector<glm::dvec3>& positions) const {
    std::vector<double> tangents;
    tangents.reserve(cells_.size());
    for (const Cell& cell : cells_) {
        const MaterialShares& material = materials_[cell.material];
        double tangent = 1;
        if (!material.breaks.empty()) {
            const double strain = tensionStrain(cell, positions);
            for (const CurveBreak& turn : material.breaks)
                tangent += strain > turn.strain ? turn.gain : 0;
            tangent = std::max(tangent, material.stiffening(strain));
        }
        tangents.push_back(tangent);
    }
    return tangents;
}

double Stiffening::energy(const std::vector<glm::dvec3>& positions) const {
    double sum = 0;
    for (const Cell& cell : cells_) {
        const MaterialShares& material = materials_[cell.material];
        const double linear = linearEnergy(cell, positions);
        if (material.breaks.empty()) {
            sum += linear;
            continue;
        }
        const double strain = material.tensionStrain(2 * linear / (cell.fill * material.young));
        double psi = 0.5 * strain * strain; // integral of sigma / E
        for (const CurveBreak& turn : material.breaks)
            if (strain > turn.strain)
                psi += 0.5 * turn.gain * (strain - turn.strain) * (strain - turn.strain);
        sum += cell.fill * material.young * psi;
    }
    return sum;
}

} // namespace serosa::sim
