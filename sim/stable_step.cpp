// The largest stable explicit step (ARCHITECTURE.md, stability). The stiffest rate omega^2 of M^-1 K on the
// rest lattice comes from Lanczos (power) iteration. No cell assembly exceeds its stiffest lone cell, the
// endless lattice has less: the estimate is kept between the two.
//
// In units of k/m, with b the volumetric term's share (sim/volume_term.h): a lone cell breathes with
//   springs: 12 edges f/4 stretch by 1, 12 diagonals f/2 by sqrt 2, sum w e^2 = 15 f; mass 8 f/8 * 3/4: 20;
//   volume:  f b (div u)^2 = 9 f b over the same mass: 12 b.
// In the endless lattice the plane wave of length 2 h along an axis has 12 from the springs and 4 b: the
// divergence of each cell is 2 in it.
#include "sim/solver.h"
#include "sim/volume_term.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kEndlessLattice = 12, kLoneCell = 20;        // omega^2 / (k/m), springs
constexpr double kEndlessLatticeBulk = 4, kLoneCellBulk = 12; // more for each unit of bulkShare()
// Of the bound. Stretch and contact raise omega^2 beyond the rest lattice's. And Verlet with springs that
// turn is unstable before the linear bound: at omega dt = sqrt(3) the stiffest modes resonate 3:1 with the
// step, at sqrt(2) 4:1; an undamped ball with random velocities blows up at 0.85 of the bound. 0.7 keeps
// every mode below both.
constexpr double kMargin = 0.7;
// The iteration approaches from below.
constexpr double kIterationSlack = 1.02;
constexpr std::size_t kIterations = 80;

/// Springs as flat lists, so that an iteration is one sweep.
struct SpringList {
    std::vector<std::uint32_t> first, second;
    std::vector<glm::dvec3> direction;
    std::vector<double> weight;
};

SpringList collectSprings(const Lattice& lattice) {
    SpringList springs;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; d += 2) {
            const std::int64_t other = lattice.neighbour(node, d);
            if (other < 0)
                continue;
            springs.first.push_back(std::uint32_t(node));
            springs.second.push_back(std::uint32_t(other));
            springs.direction.push_back(glm::normalize(glm::dvec3(kNeighbourOffsets[std::size_t(d)])));
            springs.weight.push_back(lattice.springWeight(node, d));
        }
    return springs;
}

/// y = M^-1/2 K M^-1/2 x, in units of k/m.
void applySymmetric(const SpringList& springs, const VolumeTerm& volume,
                    const std::vector<double>& inverseRootMass, const std::vector<glm::dvec3>& x,
                    std::vector<glm::dvec3>& y) {
    std::fill(y.begin(), y.end(), glm::dvec3(0));
    for (std::size_t s = 0; s < springs.first.size(); ++s) {
        const std::uint32_t a = springs.first[s], b = springs.second[s];
        const glm::dvec3& n = springs.direction[s];
        const double pull =
            springs.weight[s] * glm::dot(n, inverseRootMass[a] * x[a] - inverseRootMass[b] * x[b]);
        y[a] += inverseRootMass[a] * pull * n;
        y[b] -= inverseRootMass[b] * pull * n;
    }
    if (volume.empty())
        return;
    std::vector<glm::dvec3> scaled(x.size()), forces(x.size(), glm::dvec3(0));
    for (std::size_t node = 0; node < x.size(); ++node)
        scaled[node] = inverseRootMass[node] * x[node];
    volume.addLinear(scaled, forces);
    for (std::size_t node = 0; node < x.size(); ++node)
        y[node] += inverseRootMass[node] * forces[node];
}

double dot(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += glm::dot(a[i], b[i]);
    return sum;
}

/// Largest eigenvalue of M^-1 K in units of k/m, from below: Lanczos iteration, which is the power iteration
/// with the best combination of all its powers. Plain powers miss the stiff modes of a few barely filled
/// cells for hundreds of iterations. Lost orthogonality only repeats eigenvalues that have converged.
double stiffestShare(const Lattice& lattice, const SpringList& springs, const VolumeTerm& volume) {
    const std::size_t count = lattice.nodeCount();
    std::vector<double> inverseRootMass(count);
    std::vector<glm::dvec3> before(count, glm::dvec3(0)), now(count), next(count);
    std::uint32_t random = 12345;
    for (std::size_t i = 0; i < count; ++i) {
        inverseRootMass[i] = 1 / std::sqrt(lattice.massShare(i));
        for (int axis = 0; axis < 3; ++axis) {
            random = random * 1664525u + 1013904223u;
            now[i][axis] = double(random >> 8) / double(1u << 24) - 0.5;
        }
    }
    const double length = std::sqrt(dot(now, now));
    for (glm::dvec3& v : now)
        v /= length;
    std::vector<double> diagonal, offDiagonal;
    while (diagonal.size() < kIterations) {
        applySymmetric(springs, volume, inverseRootMass, now, next);
        const double alpha = dot(now, next), beta = offDiagonal.empty() ? 0 : offDiagonal.back();
        for (std::size_t i = 0; i < count; ++i)
            next[i] -= alpha * now[i] + beta * before[i];
        diagonal.push_back(alpha);
        offDiagonal.push_back(std::sqrt(dot(next, next)));
        if (offDiagonal.back() < 1e-9)
            break; // an invariant space: tiny lattices
        for (glm::dvec3& v : next)
            v /= offDiagonal.back();
        std::swap(before, now);
        std::swap(now, next);
    }
    const auto size = Eigen::Index(diagonal.size());
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), size),
                                  Eigen::Map<Eigen::VectorXd>(offDiagonal.data(), size - 1),
                                  Eigen::EigenvaluesOnly);
    return solver.eigenvalues().maxCoeff();
}

} // namespace

StableStep stableStep(const Lattice& lattice, const Tissue& tissue, double frameTime) {
    StableStep step;
    const double perShare = tissue.stiffnessOverMass(lattice.spacing);
    const double bulk = tissue.bulkShare();
    const SpringList springs = collectSprings(lattice);
    step.springRate2 =
        std::clamp(kIterationSlack * stiffestShare(lattice, springs, {}), kEndlessLattice, kLoneCell) *
        perShare;
    step.formulaRate2 = (kEndlessLattice + kEndlessLatticeBulk * bulk) * perShare;
    step.stiffestRate2 = step.springRate2;
    if (bulk > 0)
        step.stiffestRate2 =
            std::clamp(kIterationSlack *
                           stiffestShare(lattice, springs, VolumeTerm(lattice, tissue, lattice.connections)),
                       kEndlessLattice + kEndlessLatticeBulk * bulk, kLoneCell + kLoneCellBulk * bulk) *
            perShare;
    // Increments lag half a step, so damping tau of the springs' share lowers the bound: dt^2 omega^2 +
    // 2 dt tau omega_s^2 < 4. The stiffest modes of both are nearly the same (see above), so the sum of the
    // two largest rates is hardly more than the largest of the sum.
    const double damped = tissue.dampingTime * step.springRate2 / step.stiffestRate2;
    step.bound = std::sqrt(damped * damped + 4 / step.stiffestRate2) - damped;
    step.margin = kMargin;
    step.stepsPerFrame = int(std::ceil(frameTime / (kMargin * step.bound)));
    step.timeStep = frameTime / step.stepsPerFrame;
    return step;
}

} // namespace serosa::sim
