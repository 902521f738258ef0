// See app/verify/fem_preconditioner.h. The pieces are the boxes of a grid.
#include "app/verify/fem_preconditioner.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace serosa::app {

namespace {

constexpr double kBoxesAlong = 12; // the longest side of the solid
constexpr double kShift = 1e-6;    // of the coarse diagonal: a box of few nodes has fewer than six motions

using Matrix = FemPreconditioner::Matrix;

Matrix rigidModes(const std::vector<glm::dvec3>& nodes, const std::vector<bool>& held) {
    glm::dvec3 low = nodes.front(), high = low;
    for (const glm::dvec3& node : nodes) {
        low = glm::min(low, node);
        high = glm::max(high, node);
    }
    const glm::dvec3 extent = high - low;
    const double side = std::max({extent.x, extent.y, extent.z}) / kBoxesAlong;
    std::map<std::tuple<int, int, int>, int> boxes;
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t node = 0; node < nodes.size(); ++node) {
        if (held[node])
            continue;
        const glm::dvec3 q = (nodes[node] - low) / side;
        const glm::ivec3 box(glm::floor(q));
        const int first = 6 * boxes.try_emplace({box.x, box.y, box.z}, int(boxes.size())).first->second;
        const glm::dvec3 arm = q - glm::dvec3(box) - 0.5;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 direction(0);
            direction[axis] = 1;
            entries.emplace_back(int(3 * node) + axis, first + axis, 1);
            const glm::dvec3 turned = glm::cross(direction, arm);
            for (int i = 0; i < 3; ++i)
                if (i != axis)
                    entries.emplace_back(int(3 * node) + i, first + 3 + axis, turned[i]);
        }
    }
    Matrix modes(Eigen::Index(3 * nodes.size()), Eigen::Index(6 * boxes.size()));
    modes.setFromTriplets(entries.begin(), entries.end());
    return modes;
}

} // namespace

FemPreconditioner::FemPreconditioner(const Matrix& matrix, const std::vector<glm::dvec3>& nodes,
                                     const std::vector<bool>& held)
    : matrix_(matrix), diagonal_(matrix.diagonal()), modes_(rigidModes(nodes, held)) {
    if (modes_.cols() == 0) // all nodes are held
        return;
    const Matrix moved = matrix * modes_;
    Eigen::SparseMatrix<double> coarse = Matrix(modes_.transpose()) * moved;
    const double shift = kShift * coarse.diagonal().maxCoeff();
    for (Eigen::Index i = 0; i < coarse.rows(); ++i)
        coarse.coeffRef(i, i) += shift;
    coarse_.compute(coarse);
}

Eigen::VectorXd FemPreconditioner::solve(const Eigen::VectorXd& right) const {
    // (D + U)^-1 D (D + L)^-1
    Eigen::VectorXd sum = matrix_.triangularView<Eigen::Lower>().solve(right);
    sum = sum.cwiseProduct(diagonal_);
    sum = matrix_.triangularView<Eigen::Upper>().solve(sum);
    if (modes_.cols() > 0)
        sum += modes_ * coarse_.solve(modes_.transpose() * right).eval();
    return sum;
}

} // namespace serosa::app
