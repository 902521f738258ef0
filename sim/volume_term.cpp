// See sim/volume_term.h. Twin of shaders/cell_terms.glsl and shaders/solver_cells.glsl.
#include "sim/volume_term.h"

#include "shaders/shared_constants.h"
#include "sim/cell_volumes.h"
#include "sim/pieces.h"
#include "sim/solver.h"

#include <algorithm>

namespace serosa::sim {

namespace {

glm::dmat3 cofactors(const glm::dmat3& f) {
    return {glm::cross(f[1], f[2]), glm::cross(f[2], f[0]), glm::cross(f[0], f[1])};
}

double square(const glm::dmat3& m) {
    return glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]);
}

double softening(const glm::dmat3& cofactor) {
    const double share = std::min(1.0, SRS_VOLUME_STIFFENING / std::max(square(cofactor), 1e-12));
    return share * share;
}

/// dW/dF of sim/volume_term.h, k/h.
glm::dmat3 volumeStress(const glm::dmat3& gradient, double bulk, double recovery) {
    const glm::dmat3 cofactor = cofactors(gradient);
    const double change = glm::dot(gradient[0], cofactor[0]) - 1,
                 collapse = std::max(0.0, SRS_COLLAPSED - 1 - change);
    const double q = softening(cofactor), size = square(cofactor);
    glm::dmat3 stress = q * (bulk * change - recovery * collapse) * cofactor;
    if (size > SRS_VOLUME_STIFFENING) // dq/dF = -4 q / size (|F|^2 F - F F^T F)
        stress -= 2 * q / size * (bulk * change * change + recovery * collapse * collapse) *
                  (square(gradient) * gradient - gradient * glm::transpose(gradient) * gradient);
    return stress;
}

} // namespace

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
    return 0.5 * softening(cofactor) * (bulk * (volume - 1) * (volume - 1) + recovery * collapse * collapse);
}

} // namespace serosa::sim
