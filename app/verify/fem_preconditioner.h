#pragma once
// Preconditioner for the conjugate gradients of app/verify/fem_solid.cpp: symmetric Gauss-Seidel for what
// neighbours settle among themselves, plus the exact solution over pieces of the solid that move rigidly for
// what reaches far (additive two-level Schwarz; Toselli & Widlund 2005, Domain Decomposition Methods, ch. 3).

#include <glm/glm.hpp>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

namespace serosa::app {

class FemPreconditioner {
public:
    using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

    /// Keeps the matrix by reference: symmetric, positive diagonal, three unknowns a node; held ones have
    /// nothing but it. \param nodes where they rest. \param held one a node
    FemPreconditioner(const Matrix& matrix, const std::vector<glm::dvec3>& nodes,
                      const std::vector<bool>& held);
    /// Nearly the solution of matrix x = right; symmetric and positive definite.
    Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

private:
    const Matrix& matrix_;
    Eigen::VectorXd diagonal_;
    Matrix modes_; // a row an unknown; six columns a piece: three translations, three turns
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> coarse_;
};

} // namespace serosa::app
