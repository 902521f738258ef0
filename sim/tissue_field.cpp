// See sim/tissue_field.h. Its float32 twin is weighCells in shaders/solver_kernel.glsl.
#include "sim/tissue_field.h"

#include "base/check.h"

namespace serosa::sim {

TissueField::TissueField(const Lattice& lattice, const Tissue& tissue)
    : lattice_(&lattice), materials_(materialShares(tissue)), cellsAround_(cellsAround(lattice)) {
    for (const LatticeCell& cell : lattice.cells)
        SEROSA_CHECK(cell.material < materials_.size(), "cells of the tissue's materials");
}

/// Sum of fill (0 .. 255) times share(cell) over the cells that hold a spring, in their order around the
/// node, over 255 times the springs of a kind in a full neighbourhood.
template <class Share>
double TissueField::sumCells(std::size_t node, int d, Share share) const {
    if (!((lattice_->connections[node] >> d) & 1u))
        return 0;
    double sum = 0;
    for (int octant = 0; octant < 8; ++octant) {
        const std::int32_t cell = cellsAround_[8 * node + std::size_t(octant)];
        if (cell >= 0 && octantHolds(octant, d))
            sum += lattice_->cells[std::size_t(cell)].fill * share(std::size_t(cell));
    }
    return sum / (255.0 * (d < 6 ? 4.0 : 2.0));
}

std::vector<double> TissueField::massShares() const {
    std::vector<double> shares;
    for (std::size_t node = 0; node < lattice_->nodeCount(); ++node)
        shares.push_back(massShare(node));
    return shares;
}

double TissueField::massShare(std::size_t node) const {
    double sum = 0;
    for (std::size_t octant = 0; octant < 8; ++octant)
        if (const std::int32_t cell = cellsAround_[8 * node + octant]; cell >= 0)
            sum += lattice_->cells[std::size_t(cell)].fill * materialOf(std::size_t(cell)).density;
    return sum / (8.0 * 255.0);
}

double TissueField::springWeight(std::size_t node, int d, const std::vector<double>& cellFactors) const {
    return sumCells(node, d, [&](std::size_t cell) {
        const double constant = materialOf(cell).spring[std::size_t(d / 2)];
        return cellFactors.empty() ? constant : constant * cellFactors[cell];
    });
}

double TissueField::dampingWeight(std::size_t node, int d) const {
    return sumCells(node, d, [&](std::size_t cell) {
        const MaterialShares& material = materialOf(cell);
        return material.spring[std::size_t(d / 2)] * material.dampingTime;
    });
}

} // namespace serosa::sim
