#pragma once
// Materials that stiffen as they are stretched: soft tissue has a toe region, where collagen fibres uncoil,
// and is stiff beyond it (Fung 1993, Biomechanics, chapter 7).
//
// A cell of fill f stores U, the energy of what it holds of its springs and of its volumetric term. With a
// stress-strain curve sigma(eps) it stores f E Psi(eps) instead, where
//   U = f E/2 eps^2 (1 + a eps),   eps the tension strain at which springs alone store U,
//   Psi(eps) = integral of sigma / E from 0 to eps,
// so that each of its forces is the springs' times dPsi/dU = sigma(eps) / (E eps (1 + 3/2 a eps)), the
// curve's stress over the springs' own. This is one number a cell: forces are those of an energy, momentum,
// angular momentum, isotropy and Poisson's ratio stay as they were, and under tension the stress follows the
// curve.
//
// Springs that turn and stretch are not linear: nominal stress over E eps is 1.07 to 1.13 at a strain of 0.2
// at Poisson's ratio 0.25, and 0.96 to 1.04 at 0.45, by direction against the grid. a = 7/4 (0.45 - nu), not
// below 0, lies in the middle of all directions; what is left of their spread is how far the stress lies off
// its curve. Shear, compression and pressure stiffen by the same energy (a cell pressed on all sides by eps/3
// stores more than one stretched by eps). No deformation is stiffer than the curve's steepest tangent over
// its first one: |f.v|^2 <= 2 U v.K v for the springs' forces f, so that Psi' K + Psi'' f f^T <= (Psi' + 2 U
// Psi'') K = sigma'(eps)/E K (a = 0).
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
    /// The same of the steepest tangent, not below factors(): with them the cells' stiffness as it would be
    /// without curves is a bound of theirs. Empty where empty().
    std::vector<double> tangents(const std::vector<glm::dvec3>& positions) const;
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
    double tensionStrain(const Cell& cell, const std::vector<glm::dvec3>& positions) const;
    /// U, in units of k h^2.
    double linearEnergy(const Cell& cell, const std::vector<glm::dvec3>& positions) const;

    std::vector<MaterialShares> materials_;
    std::vector<Cell> cells_;
};

} // namespace serosa::sim
