// What else could solve the equations of an implicit step: projective dynamics (Bouaziz et al. 2014; by
// Jacobi steps with Chebyshev acceleration, Wang 2015) and XPBD (Macklin et al. 2016), beside the solver's
// own conjugate gradients. One step of 1/60 s from rest under gravity, linear, in double: both rivals at
// their best, since nothing turns, and Chebyshev knows the ends of the spectrum.
//
// Projective dynamics gives each spring w |d - p|^2 / 2, p of the spring's length and along d: its matrix has
// the whole w I where the energy's has w n n^T, and one local and global step takes x to
// x + A^-1 (b - H x), A with w I. XPBD sweeps over the springs, each with a multiplier (Gauss-Seidel).

#include "app/organ_setup.h"
#include "app/verify/implicit_bodies.h"
#include "bench/cases.h"
#include "shaders/shared_constants.h"
#include "sim/implicit_system.h"
#include "sim/tissue_field.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <functional>

namespace serosa::bench {

namespace {

using Vector = glm::dvec3;
using Vectors = std::vector<Vector>; // one a node
constexpr int kMost = 5000;          // iterations; beyond, it is not waited for

/// H x = b of one step, and the springs that H is made of.
class Step {
public:
    explicit Step(const app::ImplicitBody& body) : system_(body.setup, false) {
        const sim::Lattice& lattice = body.lattice;
        const std::size_t count = lattice.nodeCount();
        const double dt = body.setup.timeStep, h = lattice.spacing;
        const Vector gravity = body.setup.gravity * (dt * dt / h);
        sim::ImplicitSystem<double>::Step step;
        step.gravity = gravity;
        step.expected = step.guess = Vectors(count, Vector(0));
        const sim::TissueField field(lattice, body.setup.tissue);
        const double scale = dt * dt * body.setup.tissue.stiffnessOverMass(h);
        for (std::size_t node = 0; node < count; ++node) {
            const bool held = body.setup.fixed[node];
            step.positions.push_back(lattice.restPosition(node));
            step.share.push_back(held ? 0 : 1);
            free.push_back(!held);
            mass.push_back(field.massShare(node));
            for (int d = 0; d < SRS_NEIGHBOURS; d += 2)
                if (const std::int64_t other = lattice.neighbour(node, d); other >= 0)
                    springs.push_back({node, std::size_t(other),
                                       glm::normalize(lattice.restPosition(node) -
                                                      lattice.restPosition(std::size_t(other))),
                                       scale * field.springWeight(node, d)});
        }
        system_.begin(std::move(step));
        const Vectors still(count, Vector(0));
        load = still;
        system_.gradient(still, load);
        system_.linearize(still);
        for (std::size_t i = 0; i < count; ++i)
            load[i] = free[i] ? -load[i] : Vector(0);
        exact = still;
        conjugateGradients([this](const Vectors& r, Vectors& z) { system_.precondition(r, z); },
                           [](const Vectors&, double residual) { return residual < 1e-12; }, exact);
        first_ = energyNorm(exact);
    }

    Vectors apply(const Vectors& x) {
        Vectors product(x.size());
        system_.apply(x, product);
        return product;
    }
    /// Over that of staying at rest.
    double error(const Vectors& x) {
        Vectors apart = x;
        for (std::size_t i = 0; i < x.size(); ++i)
            apart[i] -= exact[i];
        return energyNorm(apart) / first_;
    }
    double dot(const Vectors& a, const Vectors& b) const { return system_.dot(a, b); }
    void precondition(const Vectors& r, Vectors& z) { system_.precondition(r, z); }

    using Preconditioner = std::function<void(const Vectors& r, Vectors& z)>;
    /// Until done(x, residual over the first in the preconditioner's norm). Returns the ends of the spectrum
    /// of the preconditioned matrix, by Lanczos.
    std::array<double, 2> conjugateGradients(const Preconditioner& precondition,
                                             const std::function<bool(const Vectors&, double)>& done,
                                             Vectors& x);

    struct Spring {
        std::size_t from, to;
        Vector along;
        double stiffness; // a w
    };
    std::vector<Spring> springs;
    std::vector<double> mass; // shares
    std::vector<bool> free;
    Vectors load, exact;

private:
    double energyNorm(const Vectors& x) { return std::sqrt(std::max(0.0, dot(x, apply(x)))); }

    sim::ImplicitSystem<double> system_;
    double first_ = 1;
};

std::array<double, 2> Step::conjugateGradients(const Preconditioner& precondition,
                                               const std::function<bool(const Vectors&, double)>& done,
                                               Vectors& x) {
    Vectors r = load, z(x.size()), p;
    precondition(r, z);
    p = z;
    double size = dot(r, z);
    const double first = size;
    std::vector<double> alphas, betas;
    while (int(alphas.size()) < kMost && !done(x, std::sqrt(size / first))) {
        const Vectors product = apply(p);
        const double alpha = size / dot(p, product);
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] += alpha * p[i];
            r[i] -= alpha * product[i];
        }
        precondition(r, z);
        const double before = size;
        size = dot(r, z);
        for (std::size_t i = 0; i < x.size(); ++i)
            p[i] = z[i] + size / before * p[i];
        alphas.push_back(alpha);
        betas.push_back(size / before);
    }
    const Eigen::Index count = Eigen::Index(alphas.size());
    if (count == 0)
        return {0, 0};
    Eigen::VectorXd diagonal(count), beside(std::max<Eigen::Index>(count - 1, 0));
    for (Eigen::Index i = 0; i < count; ++i) {
        const auto k = std::size_t(i);
        diagonal[i] = 1 / alphas[k] + (i > 0 ? betas[k - 1] / alphas[k - 1] : 0);
        if (i + 1 < count)
            beside[i] = std::sqrt(betas[k]) / alphas[k];
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
    return {solver.eigenvalues()[0], solver.eigenvalues()[count - 1]};
}

/// Iterations until the error is a hundredth, and a thousandth, of the first.
class Count {
public:
    explicit Count(Step& step) : step_(step) {}
    /// True: nothing is left to count. Call it before the first iteration, too.
    bool look(const Vectors& x) {
        const double error = step_.error(x);
        for (std::size_t i = 0; i < 2; ++i)
            if (reached_[i] < 0 && error < kGoals[i])
                reached_[i] = iterations_;
        ++iterations_;
        return reached_[1] >= 0 || iterations_ > kMost || !std::isfinite(error);
    }
    /// "35 (52)"
    std::string text() const {
        const auto one = [](int count) { return count < 0 ? std::string("-") : std::to_string(count); };
        return one(reached_[0]) + " (" + one(reached_[1]) + ")";
    }

private:
    static constexpr std::array<double, 2> kGoals = {1e-2, 1e-3};
    Step& step_;
    int iterations_ = 0;
    std::array<int, 2> reached_ = {-1, -1};
};

std::string gradients(Step& step, const Step::Preconditioner& precondition) {
    Count count(step);
    Vectors x(step.mass.size(), Vector(0));
    step.conjugateGradients(
        precondition, [&](const Vectors& now, double) { return count.look(now); }, x);
    return count.text();
}

/// Of A = M + sum of w I: what Jacobi's method on projective dynamics' matrix divides by.
std::vector<double> projectiveDiagonal(const Step& step) {
    std::vector<double> diagonal = step.mass;
    for (const Step::Spring& spring : step.springs) {
        diagonal[spring.from] += spring.stiffness;
        diagonal[spring.to] += spring.stiffness;
    }
    return diagonal;
}

Vectors residual(Step& step, const Vectors& x) {
    Vectors r = step.apply(x);
    for (std::size_t i = 0; i < r.size(); ++i)
        r[i] = step.free[i] ? step.load[i] - r[i] : Vector(0);
    return r;
}

/// Wang 2015: a Jacobi step after each projection, with Chebyshev weights.
std::string chebyshevProjective(Step& step) {
    const std::vector<double> diagonal = projectiveDiagonal(step);
    const auto jacobi = [&](const Vectors& r, Vectors& z) {
        for (std::size_t i = 0; i < r.size(); ++i)
            z[i] = r[i] / diagonal[i];
    };
    Vectors found(step.mass.size(), Vector(0));
    const auto [lowest, highest] = step.conjugateGradients(
        jacobi, [](const Vectors&, double residual) { return residual < 1e-10; }, found);
    const double radius = std::max(1 - lowest, highest - 1);
    Count count(step);
    Vectors x(found.size(), Vector(0)), before = x, change(x.size());
    double weight = 1;
    for (int k = 0; !count.look(x); ++k) {
        weight = k == 0 ? 1 : k == 1 ? 2 / (2 - radius * radius) : 4 / (4 - radius * radius * weight);
        jacobi(residual(step, x), change);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const Vector next = before[i] + weight * (x[i] + change[i] - before[i]);
            before[i] = x[i];
            x[i] = next;
        }
    }
    return count.text();
}

/// Each global step solved to the end, by a factorization made once.
std::string exactProjective(Step& step) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&entries](std::size_t i, std::size_t j, double value) {
        entries.emplace_back(int(i), int(j), value);
    };
    const std::vector<double> diagonal = projectiveDiagonal(step);
    for (std::size_t i = 0; i < diagonal.size(); ++i)
        add(i, i, diagonal[i]);
    for (const Step::Spring& spring : step.springs)
        if (step.free[spring.from] && step.free[spring.to]) {
            add(spring.from, spring.to, -spring.stiffness);
            add(spring.to, spring.from, -spring.stiffness);
        }
    const auto size = Eigen::Index(diagonal.size());
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
    Count count(step);
    Vectors x(diagonal.size(), Vector(0));
    while (!count.look(x)) {
        const Vectors r = residual(step, x);
        Eigen::MatrixXd right(size, 3);
        for (Eigen::Index i = 0; i < size; ++i)
            for (int axis = 0; axis < 3; ++axis)
                right(i, axis) = r[std::size_t(i)][axis];
        const Eigen::MatrixXd change = factors.solve(right);
        for (Eigen::Index i = 0; i < size; ++i)
            x[std::size_t(i)] += Vector(change(i, 0), change(i, 1), change(i, 2));
    }
    return count.text();
}

/// Sweeps over all springs, from where the nodes would be without them.
std::string positionBased(Step& step) {
    Count count(step);
    Vectors x(step.mass.size(), Vector(0));
    for (std::size_t i = 0; i < x.size(); ++i)
        if (step.free[i])
            x[i] = step.load[i] / step.mass[i];
    std::vector<double> multipliers(step.springs.size(), 0);
    while (!count.look(x))
        for (std::size_t s = 0; s < step.springs.size(); ++s) {
            const Step::Spring& spring = step.springs[s];
            const double fromShare = step.free[spring.from] ? 1 / step.mass[spring.from] : 0,
                         toShare = step.free[spring.to] ? 1 / step.mass[spring.to] : 0,
                         compliance = 1 / spring.stiffness;
            const double longer = glm::dot(spring.along, x[spring.from] - x[spring.to]);
            const double change =
                -(longer + compliance * multipliers[s]) / (fromShare + toShare + compliance);
            multipliers[s] += change;
            x[spring.from] += fromShare * change * spring.along;
            x[spring.to] -= toShare * change * spring.along;
        }
    return count.text();
}

} // namespace

Status benchRivals(const Options& /*options*/, Report& report) {
    std::vector<std::pair<std::string, std::unique_ptr<app::ImplicitBody>>> bodies;
    for (const auto& [name, young] : {std::pair{"ball, 1 kPa", 1e3},
                                      {"ball, 20 kPa", 2e4},
                                      {"ball, 1 MPa", 1e6},
                                      {"ball of 1 kPa in a capsule of 1 MPa", 0.0}}) {
        bodies.emplace_back(name, app::capsuleBody(20));
        sim::Tissue& tissue = bodies.back().second->setup.tissue;
        tissue.dampingTime = tissue.others[0].dampingTime = 0;
        if (young > 0)
            tissue.young = tissue.others[0].young = young;
    }
    bodies.emplace_back("beam held at one end, 1 MPa",
                        std::make_unique<app::ImplicitBody>(app::blockOfCells({60, 8, 8}, 0.003), 1e6));
    bodies.back().second->fixWhere([](const glm::ivec3& node) { return node.x == 0; });
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, body] : bodies) {
        Step step(*body);
        rows.push_back({name, std::to_string(body->lattice.nodeCount()),
                        gradients(step, [&](const Vectors& r, Vectors& z) { step.precondition(r, z); }),
                        exactProjective(step), chebyshevProjective(step), positionBased(step)});
    }
    report.heading("What else could solve an implicit step");
    report.table({"body", "nodes", "conjugate gradients, multilevel",
                  "projective dynamics, exact global steps", "projective dynamics, Jacobi and Chebyshev",
                  "XPBD, sweeps"},
                 rows);
    report.line(
        "\nIterations until the error in the energy norm is 1e-2 (1e-3) of that of staying, one linear step "
        "of 1/60 s from rest under gravity; -: more than " +
        std::to_string(kMost) + ".");
    return {};
}

} // namespace serosa::bench
