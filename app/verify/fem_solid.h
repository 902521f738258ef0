#pragma once
// Linear elasticity with quadratic tetrahedra, written without a line of the lattice's code: what the lattice
// is compared with. Straight-sided elements of ten nodes, four Gauss points, which integrate the stiffness of
// such elements exactly (Zienkiewicz & Taylor, The Finite Element Method, vol. 1, ch. 8).

#include "app/verify/tet_mesh.h"

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace serosa::app {

struct ElasticSolid {
    double young = 0; // Pa
    double poisson = 0;
    double lambda() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); } // Pa
    double mu() const { return young / (2 * (1 + poisson)); }                               // Pa
};

/// A point of an element for integration and comparison.
struct TetPoint {
    std::array<double, 10> shapes;        // values of the shape functions
    std::array<glm::dvec3, 10> gradients; // 1/m
    double volume = 0;                    // m3 that the point stands for
};
/// The four Gauss points of an element.
std::array<TetPoint, 4> gaussPoints(const TetMesh& mesh, std::size_t element);

/// Row-major so that its rows can be worked on; three unknowns a node (x, y, z); N/m.
using FemMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
FemMatrix femStiffness(const TetMesh& mesh, const ElasticSolid& solid);

/// Nodal forces of a force on each volume, N/m3: N, three a node.
Eigen::VectorXd bodyForces(const TetMesh& mesh, const glm::dvec3& perVolume);

/// Displacements, m, under nodal forces (N), where held nodes take the displacements given for them.
/// Conjugate gradients, to `tolerance` in the energy norm. \param held one a node. \param given three a node,
/// or empty: 0. Errors: it does not converge (nothing is held).
Result<Eigen::VectorXd> solveFem(const TetMesh& mesh, FemMatrix stiffness, const Eigen::VectorXd& forces,
                                 const std::vector<bool>& held, const Eigen::VectorXd& given = {},
                                 double tolerance = 1e-6);

/// Displacement of a point of an element, m.
glm::dvec3 displacementAt(const TetMesh& mesh, std::size_t element, const TetPoint& point,
                          const Eigen::VectorXd& displacements);

/// Largest size of a principal strain over all Gauss points.
double largestStrain(const TetMesh& mesh, const Eigen::VectorXd& displacements);

} // namespace serosa::app
