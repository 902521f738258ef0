#pragma once
// The volumetric term: what raises Poisson's ratio above the springs' 1/4, and what turns collapsed and
// inverted cells right again.
//
// A cell with fill f whose 24 connections are all there has, in lattice units and units of k h^2, with
//   g_i = (+-1, +-1, +-1)/4 the corner gradients,  F = sum_i x_i g_i^T (the mean over the cell),  J = det F,
// the energy f W and the corner forces -f dW/dF g_i:
//   W = q/2 (b (J - 1)^2 + r max(0, J0 - J)^2),      b = bulkShare(),  r = kRecovery, J0 = kCollapsed,
//   dW/dF = q (b (J - 1) - r max(0, J0 - J)) cof(F) + dq/dF W/q.
// With several materials k is that of material 0, and b and r are MaterialShares::bulk and ::recovery of the
// cell's own. A cell that has stiffened (sim/stiffening.h) has its factor on b.
// Linearized this is the energy f b/2 (div u)^2 h^3, so lambda = (1 + b) k/h and mu = k/h stay as they were.
// One point a cell is a selective reduced integration: nothing locks at Poisson's ratio 0.49, and the springs
// resist the modes that the mean does not see. sum_i g_i = 0 keeps momentum; dW/dF F^T is symmetric, since W
// does not change with a rotation, which keeps angular momentum: both exactly.
//
// q = min(1, (kStiffening / |cof F|^2)^2) is 1 until a cell is squeezed by more than 30%; beyond,
// dq/dF = -4 q / |cof F|^2 (|F|^2 F - F F^T F). (Without that part the force has no energy, and undamped
// tissue gains some with every swing.) The tangent stiffness grows with |cof F|^2 (4 b |cof F|_2^2 k/m for
// the stiffest mode): unscaled, a cell that is pressed to half its height has four times the rest lattice's,
// and no step found at rest would be stable. With q it stays below 2.2 times of that, and 0.7 of the bound is
// stable up to 2.04 times.
//
// Recovery: springs have no energy in a cell that is turned inside out. W(J) of the second term pushes J up
// from below J0 = 0.4, that is 26% of linear strain on all sides, or 60% along one axis: nothing changes for
// any smaller strain. r must exceed 2.5: flattened cells are pushed back together by springs with k h at J =
// 0. It needs no smaller step: in a flattened cell the stiffest mode of the springs has fallen from 12 k/m
// below what the term adds, 4 r = 12. That holds for flattened cells. One that is inside out and drawn out by
// a factor s has J0 - J and |cof F| of the order s^3 and s^2: without q the push grew with s^5, and tissue
// that was dragged about by a grasp blew up within a few steps.

#include "sim/cell_volumes.h"
#include "sim/lattice.h"
#include "sim/material.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

class VolumeTerm {
public:
    VolumeTerm() = default; // no cells: adds nothing
    /// \param connections 18 bits a node, what cuts left; a cell that lost one has no volumetric term.
    VolumeTerm(const Lattice& lattice, const Tissue& tissue, const std::vector<std::uint32_t>& connections);

    bool empty() const { return cells_.empty(); }
    /// Adds the corner forces, in units of k h, to `force`, one a node.
    /// \param cellFactors one a cell of the lattice: what its b is multiplied by; empty: 1
    void addForces(const std::vector<glm::dvec3>& positions, std::vector<glm::dvec3>& force,
                   const std::vector<double>& cellFactors = {}) const;
    /// In units of k h^2.
    double energy(const std::vector<glm::dvec3>& positions) const;
    /// The part of it that recovery adds.
    double recoveryEnergy(const std::vector<glm::dvec3>& positions) const;
    /// Adds y = K x of the linearized term, in units of k.
    /// \param cellFactors as above
    void addLinear(const std::vector<glm::dvec3>& x, std::vector<glm::dvec3>& y,
                   const std::vector<double>& cellFactors = {}) const;

private:
    struct Cell {
        CellCorners corners;
        std::size_t index; // in lattice.cells
        double fill, bulk, recovery;
    };
    std::vector<Cell> cells_;
};

/// W of one cell, in units of k h^2, from its mean deformation gradient.
double volumeEnergy(const glm::dmat3& gradient, double bulk, double recovery);

} // namespace serosa::sim
