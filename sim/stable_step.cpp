// The largest stable explicit step (ARCHITECTURE.md, stability). The stiffest rate omega^2 of M^-1 K on the
// rest lattice comes from power iteration. No cell assembly exceeds its stiffest lone cell (20 k/m), the
// endless lattice has 12 k/m: the estimate is kept between the two.
#include "sim/solver.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kEndlessLattice = 12, kLoneCell = 20; // omega^2 / (k/m)
// Of the bound: stretch and contact raise omega^2 beyond the rest lattice's.
constexpr double kMargin = 0.85;
// Power iteration approaches from below.
constexpr double kIterationSlack = 1.03;

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

/// Largest eigenvalue of M^-1 K in units of k/m.
double stiffestShare(const Lattice& lattice) {
    const SpringList springs = collectSprings(lattice);
    std::vector<glm::dvec3> mode(lattice.nodeCount()), force(lattice.nodeCount());
    std::vector<double> mass(lattice.nodeCount());
    std::uint32_t random = 12345;
    for (std::size_t i = 0; i < mode.size(); ++i) {
        mass[i] = lattice.massShare(i);
        for (int axis = 0; axis < 3; ++axis) {
            random = random * 1664525u + 1013904223u;
            mode[i][axis] = double(random >> 8) / double(1u << 24) - 0.5;
        }
    }
    const int iterations = int(std::clamp(4.0e6 / double(mode.size() + 1), 20.0, 200.0));
    double share = 0;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        std::fill(force.begin(), force.end(), glm::dvec3(0));
        for (std::size_t s = 0; s < springs.first.size(); ++s) {
            const glm::dvec3& n = springs.direction[s];
            const glm::dvec3 pull =
                springs.weight[s] * glm::dot(n, mode[springs.first[s]] - mode[springs.second[s]]) * n;
            force[springs.first[s]] += pull;
            force[springs.second[s]] -= pull;
        }
        double work = 0, norm = 0, scale = 0;
        for (std::size_t i = 0; i < mode.size(); ++i) {
            work += glm::dot(mode[i], force[i]);
            norm += mass[i] * glm::dot(mode[i], mode[i]);
            mode[i] = force[i] / mass[i];
            scale = std::max(scale, glm::length(mode[i]));
        }
        share = norm > 0 ? work / norm : 0; // Rayleigh quotient
        for (glm::dvec3& v : mode)
            v /= scale > 0 ? scale : 1;
    }
    return share;
}

} // namespace

StableStep stableStep(const Lattice& lattice, const Tissue& tissue, double frameTime) {
    StableStep step;
    const double perShare = tissue.stiffnessOverMass(lattice.spacing);
    step.formulaRate2 = kEndlessLattice * perShare;
    step.stiffestRate2 =
        std::clamp(kIterationSlack * stiffestShare(lattice), kEndlessLattice, kLoneCell) * perShare;
    // Increments lag half a step, so damping tau omega^2 lowers the bound: dt^2 omega^2 + 2 dt tau omega^2
    // < 4.
    const double tau = tissue.dampingTime;
    step.bound = std::sqrt(tau * tau + 4 / step.stiffestRate2) - tau;
    step.margin = kMargin;
    step.stepsPerFrame = int(std::ceil(frameTime / (kMargin * step.bound)));
    step.timeStep = frameTime / step.stepsPerFrame;
    return step;
}

} // namespace serosa::sim
