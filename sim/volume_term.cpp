// See sim/volume_term.h. Twin of shaders/solver_volume.glsl and shaders/volume_cells.frag.
#include "sim/volume_term.h"

#include "shaders/shared_constants.h"
#include "sim/cell_volumes.h"
#include "sim/solver.h"

#include <algorithm>

namespace serosa::sim {

namespace {

glm::dmat3 cofactors(const glm::dmat3& f) {
    return {glm::cross(f[1], f[2]), glm::cross(f[2], f[0]), glm::cross(f[0], f[1])};
}

double softening(const glm::dmat3& cofactor) {
    const double square = glm::dot(cofactor[0], cofactor[0]) + glm::dot(cofactor[1], cofactor[1]) +
                          glm::dot(cofactor[2], cofactor[2]);
    const double share = std::min(1.0, SRS_VOLUME_STIFFENING / std::max(square, 1e-12));
    return share * share;
}

} // namespace

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

VolumeTerm::VolumeTerm(const Lattice& lattice, const Tissue& tissue,
                       const std::vector<std::uint32_t>& connections)
    : bulk_(tissue.bulkShare()), recovery_(tissue.recovery ? SRS_RECOVERY : 0) {
    SEROSA_CHECK(connections.size() == lattice.nodeCount(), "connections of this lattice");
    if (!tissue.volumetric())
        return;
    for (const LatticeCell& cell : lattice.cells) {
        const Cell added{cornersOf(lattice, cell), cell.fill / 255.0};
        bool whole = true;
        for (int c = 0; c < 8; ++c) {
            const std::uint32_t needed = directionsInCell(c);
            whole = whole && (connections[added.corners[std::size_t(c)]] & needed) == needed;
        }
        if (whole)
            cells_.push_back(added);
    }
}

void VolumeTerm::addForces(const std::vector<glm::dvec3>& positions, std::vector<glm::dvec3>& force) const {
    for (const Cell& cell : cells_) {
        const glm::dmat3 gradient = meanGradient(cell.corners, positions);
        const glm::dmat3 cofactor = cofactors(gradient);
        const double volume = glm::dot(gradient[0], cofactor[0]);
        const double pressure =
            bulk_ * (volume - 1) * softening(cofactor) - recovery_ * std::max(0.0, SRS_COLLAPSED - volume);
        for (int c = 0; c < 8; ++c)
            force[cell.corners[std::size_t(c)]] -= 0.25 * cell.fill * pressure * (cofactor * cornerSign(c));
    }
}

double VolumeTerm::energy(const std::vector<glm::dvec3>& positions) const {
    double sum = 0;
    for (const Cell& cell : cells_) {
        const glm::dmat3 gradient = meanGradient(cell.corners, positions);
        const glm::dmat3 cofactor = cofactors(gradient);
        const double volume = glm::dot(gradient[0], cofactor[0]);
        const double collapse = std::max(0.0, SRS_COLLAPSED - volume);
        sum += 0.5 * cell.fill *
               (bulk_ * softening(cofactor) * (volume - 1) * (volume - 1) + recovery_ * collapse * collapse);
    }
    return sum;
}

void VolumeTerm::addLinear(const std::vector<glm::dvec3>& x, std::vector<glm::dvec3>& y) const {
    for (const Cell& cell : cells_) {
        double divergence = 0;
        for (int c = 0; c < 8; ++c)
            divergence += 0.25 * glm::dot(cornerSign(c), x[cell.corners[std::size_t(c)]]);
        for (int c = 0; c < 8; ++c)
            y[cell.corners[std::size_t(c)]] += (0.25 * cell.fill * bulk_ * divergence) * cornerSign(c);
    }
}

Status supportsTissue(const std::string& solver, const Tissue& tissue) {
    if (!tissue.volumetric() || solver == "reference" || solver == "fragment")
        return {};
    return Error{"the " + solver + " solver has no volumetric term, which " +
                 (tissue.poisson > 0.25 ? "a Poisson's ratio above 0.25" : "recovery") +
                 " needs: take --solver fragment or reference"};
}

} // namespace serosa::sim
