#pragma once
// Materials that stiffen as they are stretched: soft tissue has a toe region, where collagen fibres uncoil,
// and is stiff beyond it (Fung 1993, Biomechanics, chapter 7).
//
// A cell of fill f stores U, the energy of what it holds of its springs and of its volumetric term, as if it
// were linear. With a stress-strain curve sigma(eps) it stores f E Psi(eps) instead, where
//   eps = sqrt(2 U / (f E)),   the tension strain that stores as much,
//   Psi(eps) = integral of sigma / E from 0 to eps,
// so that each of its forces is the linear one times dPsi/dU = sigma(eps) / (E eps), the secant of the curve.
// This is one number a cell: forces are those of an energy, momentum, angular momentum, isotropy and
// Poisson's ratio stay as they were, and under tension the stress follows the curve. Shear, compression and
// pressure stiffen by the same energy (a cell pressed on all sides by eps/3 stores more than one stretched
// by eps). No deformation is stiffer than the curve's steepest tangent over its first one: |f.v|^2 <= 2 U v.K
// v for the linear forces f, so that Psi' K + Psi'' f f^T <= (Psi' + 2 U Psi'') K = sigma'(eps)/E K.
//
// Damping stays that of the first slope. Springs that are cut store nothing; a cell that a cut runs through
// has no volumetric term.

#include "sim/cell_volumes.h"
#include "sim/tissue_field.h"

#include <array>
#include <cstdint>
#include <vector>

namespace serosa::sim {

class Stiffening {
public:
    Stiffening() = default; // no cell stiffens
    /// \param connections 18 bits a node, what cuts left.
    Stiffening(const Lattice& lattice, const Tissue& tissue, const std::vector<std::uint32_t>& connections);

    /// Does any material stiffen?
    bool empty() const { return cells_.empty(); }
    /// One a cell, in the order of lattice.cells: by how much its forces grow. Empty where empty().
    std::vector<double> factors(const std::vector<glm::dvec3>& positions) const;
    /// Elastic energy of all cells, in units of k h^2 of material 0 (recovery not counted). Only where not
    /// empty().
    double energy(const std::vector<glm::dvec3>& positions) const;

private:
    struct Cell {
        CellCorners corners;
        std::array<std::uint32_t, 8> bits{}; // of the cell's springs that are left, at each corner
        double fill = 0;
        bool whole = false;
        std::uint8_t material = 0;
    };
    /// U, in units of k h^2.
    double linearEnergy(const Cell& cell, const std::vector<glm::dvec3>& positions) const;

    std::vector<MaterialShares> materials_;
    std::vector<Cell> cells_;
};

} // namespace serosa::sim
