#pragma once
// Statics of the lattice with small displacements, in double: stiffness matrix w_ij n n^T from the lattice's
// springs and f b g g^T from the cells' mean divergence. All in lattice units: k = h = 1, three unknowns a
// node (x, y, z), in the lattice's node order. serosa::app::linearForceMismatch ties it to the reference
// solver's forces.

#include "sim/lattice.h"
#include "sim/material.h"

#include <glm/glm.hpp>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <vector>

namespace serosa::app {

/// The three unknowns of a node.
glm::dvec3 nodeVector(const Eigen::VectorXd& v, std::size_t node);

/// Each material at the first slope of its curve; k is that of material 0.
Eigen::SparseMatrix<double> latticeStiffness(const sim::Lattice& lattice, const sim::Tissue& tissue);

/// A corner of the cell around a point: its node, -1 where there is none, and its weight in trilinear
/// interpolation.
struct TrilinearCorner {
    std::int64_t node = -1;
    double weight = 0;
};
/// \param place in lattice units. The weights sum to 1.
std::array<TrilinearCorner, 8> trilinearCorners(const sim::Lattice& lattice, const glm::dvec3& place);

/// A linear static problem: loads, nodes that are held, and stiff springs that prescribe displacements along
/// directions.
class LatticeProblem {
public:
    /// Keeps the lattice by reference.
    explicit LatticeProblem(const sim::Lattice& lattice);

    /// Adds a force, in k h.
    void push(std::size_t node, const glm::dvec3& force);
    /// The node does not move at all.
    void hold(std::size_t node);
    /// A spring of 1,000 k pulls the node to this displacement (h) along a unit direction.
    void prescribe(std::size_t node, const glm::dvec3& direction, double displacement);

    /// Displacements in h, by conjugate gradients to 1e-8 of the load.
    Eigen::VectorXd solve(const sim::Tissue& tissue) const;

private:
    const sim::Lattice& lattice_;
    std::vector<Eigen::Triplet<double>> extra_; // stiffness beyond the lattice's
    Eigen::VectorXd load_;
    std::vector<bool> held_;
};

} // namespace serosa::app
