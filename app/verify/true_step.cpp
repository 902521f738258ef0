// See app/verify/true_step.h.
#include "app/verify/true_step.h"

#include "sim/tissue_field.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace serosa::app {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Eigen::Index kDense = 300; // degrees of freedom
constexpr int kMostIterations = 400;
constexpr double kConverged = 1e-7, kSmall = 1e-5; // share of the eigenvalue; displacement, lattice units

/// M^-1/2 K M^-1/2 and M^-1/2 C M^-1/2, in 1/s^2 and 1/s, by steps of a solver.
class Operators {
public:
    Operators(const sim::Lattice& lattice, const sim::Tissue& tissue) : drag_(tissue.airDrag) {
        setup_.lattice = &lattice;
        setup_.tissue = tissue;
        setup_.tissue.airDrag = 0;
        setup_.timeStep = sim::stableStep(lattice, tissue, 1).timeStep; // any
        solver_ = sim::makeReferenceSolver(setup_);
        rest_ = sim::restState(lattice);
        const sim::TissueField field(lattice, tissue);
        rootMass_.resize(Eigen::Index(3 * lattice.nodeCount()));
        for (Eigen::Index i = 0; i < rootMass_.size(); ++i)
            rootMass_[i] = std::sqrt(field.massShare(std::size_t(i / 3)));
    }

    Eigen::Index size() const { return rootMass_.size(); }
    double drag() const { return drag_; }
    bool damped() const { return setup_.tissue.damped(); }

    VectorXd stiffness(const VectorXd& x) {
        const VectorXd scaled = x.cwiseQuotient(rootMass_);
        const VectorXd force = step(kSmall * scaled, false) - step(-kSmall * scaled, false);
        const double dt = setup_.timeStep;
        return -rootMass_.cwiseProduct(force) / (2 * kSmall * dt * dt);
    }
    VectorXd damping(const VectorXd& x) {
        const VectorXd scaled = x.cwiseQuotient(rootMass_);
        return rootMass_.cwiseProduct(scaled - step(scaled, true)) / setup_.timeStep;
    }
    /// dt^2 K + 2 dt C
    VectorXd both(const VectorXd& x, double dt) {
        VectorXd sum = dt * dt * stiffness(x);
        if (damped())
            sum += 2 * dt * damping(x);
        return sum;
    }

private:
    /// Increments after one step from rest displaced by x, or with the increments x.
    VectorXd step(const VectorXd& x, bool asIncrement) {
        sim::LatticeState state = rest_;
        for (Eigen::Index i = 0; i < x.size(); ++i)
            (asIncrement ? state.increments : state.positions)[std::size_t(i / 3)][glm::length_t(i % 3)] +=
                x[i];
        solver_->setState(state);
        solver_->advance(1);
        const sim::LatticeState after = solver_->state();
        VectorXd increments(x.size());
        for (Eigen::Index i = 0; i < x.size(); ++i)
            increments[i] = after.increments[std::size_t(i / 3)][glm::length_t(i % 3)];
        return increments;
    }

    sim::SolverSetup setup_;
    double drag_;
    std::unique_ptr<sim::Solver> solver_;
    sim::LatticeState rest_;
    VectorXd rootMass_;
};

/// Of dt^2 K + 2 dt C; `share` is how far the sum's own part is from converged. `start` follows, so that a
/// neighbouring dt begins near its answer.
double largestEigenvalue(Operators& operators, double dt, VectorXd& start, double& residual) {
    MatrixXd basis(operators.size(), kMostIterations + 1);
    basis.col(0) = start.normalized();
    std::vector<double> diagonal, offDiagonal;
    for (int i = 0;; ++i) {
        VectorXd next = operators.both(basis.col(i), dt);
        diagonal.push_back(basis.col(i).dot(next));
        for (int pass = 0; pass < 2; ++pass)
            next -= basis.leftCols(i + 1) * (basis.leftCols(i + 1).transpose() * next);
        offDiagonal.push_back(next.norm());
        const bool full = i + 1 == kMostIterations || i + 1 == operators.size();
        if (full || i % 20 == 19 || offDiagonal.back() < 1e-12) {
            Eigen::SelfAdjointEigenSolver<MatrixXd> small;
            small.computeFromTridiagonal(Eigen::Map<VectorXd>(diagonal.data(), i + 1),
                                         Eigen::Map<VectorXd>(offDiagonal.data(), i));
            const double value = small.eigenvalues()[i];
            const VectorXd vector = small.eigenvectors().col(i);
            residual = offDiagonal.back() * std::abs(vector[i]) / value;
            if (full || residual < kConverged) {
                start = basis.leftCols(i + 1) * vector;
                return value;
            }
        }
        basis.col(i + 1) = next / offDiagonal.back();
    }
}

MatrixXd denseOf(Eigen::Index size, const std::function<VectorXd(const VectorXd&)>& apply) {
    MatrixXd matrix(size, size);
    for (Eigen::Index i = 0; i < size; ++i)
        matrix.col(i) = apply(VectorXd::Unit(size, i));
    return 0.5 * (matrix + matrix.transpose());
}

/// dt with largest(dt) = 4 - 2 drag dt. `largest` grows between dt and dt^2.
double solve(const std::function<double(double)>& largest, double drag, double guess) {
    double dt = guess;
    for (int i = 0; i < 50; ++i) {
        const double ratio = (4 - 2 * drag * dt) / largest(dt);
        const double next = dt * (ratio < 0 ? 0.5 : std::sqrt(ratio));
        if (std::abs(next - dt) < 1e-7 * dt)
            return next;
        dt = next;
    }
    return dt;
}

} // namespace

TrueStep trueStep(const sim::Lattice& lattice, const sim::Tissue& tissue) {
    Operators operators(lattice, tissue);
    const double guess = sim::stableStep(lattice, tissue, 1).bound;
    TrueStep result;
    if (operators.size() <= kDense) {
        const MatrixXd stiffness = denseOf(operators.size(),
                                           [&](const VectorXd&x) { return operators.stiffness(x); }),
                       damping =
                           denseOf(operators.size(), [&](const VectorXd&x) { return operators.damping(x); });
        result.bound = solve(
            [&](double dt) {
                const MatrixXd sum = dt * dt * stiffness + 2 * dt * damping;
                return Eigen::SelfAdjointEigenSolver<MatrixXd>(sum, Eigen::EigenvaluesOnly)
                    .eigenvalues()
                    .maxCoeff();
            },
            operators.drag(), guess);
        return result;
    }
    VectorXd start(operators.size());
    std::mt19937 random(1);
    for (double& x : start)
        x = double(random()) / 2147483648.0 - 1;
    result.bound = solve([&](double dt) { return largestEigenvalue(operators, dt, start, result.residual); },
                         operators.drag(), guess);
    return result;
}

} // namespace serosa::app
