#pragma once
// Statics of the lattice with small displacements, in double: stiffness matrix w_ij n n^T from the lattice's
// springs and f b g g^T from the cells' mean divergence. All in lattice units: k = h = 1, three unknowns a
// node (x, y, z), in the lattice's node order. serosa::app::linearForceMismatch ties it to the reference
// solver's forces.

#include "sim/lattice.h"

#include <glm/glm.hpp>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace serosa::app {

/// The three unknowns of a node.
glm::dvec3 nodeVector(const Eigen::VectorXd& v, std::size_t node);

/// \param bulk (lambda - mu) / mu of the volumetric term
Eigen::SparseMatrix<double> latticeStiffness(const sim::Lattice& lattice, double bulk);

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
    Eigen::VectorXd solve(double bulk) const;

private:
    const sim::Lattice& lattice_;
    std::vector<Eigen::Triplet<double>> extra_; // stiffness beyond the lattice's
    Eigen::VectorXd load_;
    std::vector<bool> held_;
};

} // namespace serosa::app
