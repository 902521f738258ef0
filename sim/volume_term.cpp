// See sim/volume_term.h. Twin of shaders/cell_terms.glsl and shaders/solver_cells.glsl.
#include "sim/volume_term.h"

#include "shaders/shared_constants.h"
#include "sim/cell_volumes.h"
#include "sim/pieces.h"
#include "sim/solver.h"
#include "sim/volume_law.h"

#include <algorithm>

namespace serosa::sim {

VolumeTerm::VolumeTerm(const Lattice& lattice, const Tissue& tissue,
                       const std::vector<std::uint32_t>& connections) {
    SEROSA_CHECK(connections.size() == lattice.nodeCount(), "connections of this lattice");
    if (!tissue.volumetric())
        return;
    const std::vector<MaterialShares> materials = materialShares(tissue);
    const std::vector<bool> whole = wholeCells(lattice, connections);
    for (std::size_t i = 0; i < lattice.cells.size(); ++i) {
        const LatticeCell& cell = lattice.cells[i];
        SEROSA_CHECK(cell.material < materials.size(), "cells of the tissue's materials");
        const MaterialShares& material = materials[cell.material];
        const Cell added{cornersOf(lattice, cell), i, cell.fill / 255.0, material.bulk, material.recovery};
        if (whole[i] && (added.bulk > 0 || added.recovery > 0))
            cells_.push_back(added);
    }
}

void VolumeTerm::addForces(const std::vector<glm::dvec3>& positions, std::vector<glm::dvec3>& force,
                           const std::vector<double>& cellFactors) const {
    for (const Cell& cell : cells_) {
        const double bulk = cellFactors.empty() ? cell.bulk : cell.bulk * cellFactors[cell.index];
        const glm::dmat3 stress = volumeStress(meanGradient(cell.corners, positions), bulk, cell.recovery);
        for (int c = 0; c < 8; ++c)
            force[cell.corners[std::size_t(c)]] -= 0.25 * cell.fill * (stress * cornerSign(c));
    }
}

double VolumeTerm::energy(const std::vector<glm::dvec3>& positions) const {
    double sum = 0;
    for (const Cell& cell : cells_)
        sum += cell.fill * volumeEnergy(meanGradient(cell.corners, positions), cell.bulk, cell.recovery);
    return sum;
}

double VolumeTerm::recoveryEnergy(const std::vector<glm::dvec3>& positions) const {
    double sum = 0;
    for (const Cell& cell : cells_)
        if (cell.recovery > 0)
            sum += cell.fill * volumeEnergy(meanGradient(cell.corners, positions), 0, cell.recovery);
    return sum;
}

void VolumeTerm::addLinear(const std::vector<glm::dvec3>& x, std::vector<glm::dvec3>& y,
                           const std::vector<double>& cellFactors) const {
    for (const Cell& cell : cells_) {
        const double bulk = cellFactors.empty() ? cell.bulk : cell.bulk * cellFactors[cell.index];
        double divergence = 0;
        for (int c = 0; c < 8; ++c)
            divergence += 0.25 * glm::dot(cornerSign(c), x[cell.corners[std::size_t(c)]]);
        for (int c = 0; c < 8; ++c)
            y[cell.corners[std::size_t(c)]] += (0.25 * cell.fill * bulk * divergence) * cornerSign(c);
    }
}

double volumeEnergy(const glm::dmat3& gradient, double bulk, double recovery) {
    const glm::dmat3 cofactor = cofactors(gradient);
    const double volume = glm::dot(gradient[0], cofactor[0]);
    const double collapse = std::max(0.0, SRS_COLLAPSED - volume);
    return 0.5 * volumeSoftening(frobenius2(cofactor)) *
           (bulk * (volume - 1) * (volume - 1) + recovery * collapse * collapse);
}

} // namespace serosa::sim
