#pragma once
// What a tissue of one or several materials makes of a lattice, in units of material 0 (sim/material.h): a
// cell gives each of its 12 edges f k_m/4, each of its 12 face diagonals f k_m/2, each corner the mass
// f rho_m h^3/8; a spring sums the shares of the cells that hold it. With one material these are the
// lattice's own weights, bit by bit.

#include "sim/lattice.h"
#include "sim/material.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

class TissueField {
public:
    /// Keeps a reference to the lattice.
    TissueField(const Lattice& lattice, const Tissue& tissue);

    const std::vector<MaterialShares>& materials() const { return materials_; }
    const MaterialShares& materialOf(std::size_t cell) const {
        return materials_[lattice_->cells[cell].material];
    }
    /// In units of rho h^3 of material 0.
    double massShare(std::size_t node) const;
    std::vector<double> massShares() const; // one a node
    /// In units of k of material 0. 0 where the lattice has no connection.
    /// \param cellFactors one a cell: how many times as stiff it is (sim/stiffening.h); empty: 1
    double springWeight(std::size_t node, int d, const std::vector<double>& cellFactors = {}) const;
    /// c of a spring over k of material 0, s: its cells' shares, each times its material's damping time.
    double dampingWeight(std::size_t node, int d) const;

private:
    template <class Share>
    double sumCells(std::size_t node, int d, Share share) const;

    const Lattice* lattice_;
    std::vector<MaterialShares> materials_;
    std::vector<std::int32_t> cellsAround_; // 8 a node
};

} // namespace serosa::sim
