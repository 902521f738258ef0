// The largest stable explicit step (ARCHITECTURE.md, stability). The stiffest rate omega^2 of M^-1 K on the
// rest lattice comes from Lanczos (power) iteration. No cell assembly exceeds its stiffest lone cell, the
// endless lattice has less: the estimate is kept between the two.
//
// Several materials: the iteration runs on the springs and cells as they are, each material at the steepest
// tangent of its curve; no assembly exceeds the lone cell of its stiffest material.
//
// In units of k/m, with b the volumetric term's share (sim/volume_term.h): a lone cell breathes with
//   springs: 12 edges f/4 stretch by 1, 12 diagonals f/2 by sqrt 2, sum w e^2 = 15 f; mass 8 f/8 * 3/4: 20;
//   volume:  f b (div u)^2 = 9 f b over the same mass: 12 b.
// In the endless lattice the plane wave of length 2 h along an axis has 12 from the springs and 4 b: the
// divergence of each cell is 2 in it.
#include "sim/shape_distance.h"
#include "sim/solver.h"
#include "sim/tissue_field.h"
#include "sim/volume_term.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr double kEndlessLattice = 12, kEndlessLatticeBulk = 4; // omega^2 / (k/m): springs, a unit of bulk
// Of the bound. Stretch and contact raise omega^2 beyond the rest lattice's. And Verlet with springs that
// turn is unstable before the linear bound: at omega dt = sqrt(3) the stiffest modes resonate 3:1 with the
// step, at sqrt(2) 4:1; an undamped ball with random velocities blows up at 0.85 of the bound. 0.7 keeps
// every mode below both.
constexpr double kMargin = 0.7;
constexpr double kImplicitWay = 0.5; // spacings that a tool may go in an implicit step
constexpr double kMostSteps = 1e9;   // a frame; more cannot be counted
// The iteration approaches from below.
constexpr double kIterationSlack = 1.02;
constexpr std::size_t kIterations = 80;

/// Springs as flat lists, so that an iteration is one sweep.
struct SpringList {
    std::vector<std::uint32_t> first, second;
    std::vector<glm::dvec3> direction;
    std::vector<double> weight;
};

/// \param weight of the spring from a node in direction d
template <class Weight>
SpringList collectSprings(const Lattice& lattice, Weight weight) {
    SpringList springs;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; d += 2) {
            const std::int64_t other = lattice.neighbour(node, d);
            if (other < 0)
                continue;
            springs.first.push_back(std::uint32_t(node));
            springs.second.push_back(std::uint32_t(other));
            springs.direction.push_back(glm::normalize(glm::dvec3(kNeighbourOffsets[std::size_t(d)])));
            springs.weight.push_back(weight(node, d));
        }
    return springs;
}

/// The stiffness of a lattice and its masses, in units of k and m of material 0.
struct Operator {
    const SpringList& springs;
    const VolumeTerm& volume;
    const std::vector<double>& cellFactors; // on the volumetric term
    const std::vector<double>& inverseRootMass;
};

/// y = M^-1/2 K M^-1/2 x, in units of k/m.
void applySymmetric(const Operator& stiffness, const std::vector<glm::dvec3>& x, std::vector<glm::dvec3>& y) {
    const SpringList& springs = stiffness.springs;
    const std::vector<double>& inverseRootMass = stiffness.inverseRootMass;
    std::fill(y.begin(), y.end(), glm::dvec3(0));
    for (std::size_t s = 0; s < springs.first.size(); ++s) {
        const std::uint32_t a = springs.first[s], b = springs.second[s];
        const glm::dvec3& n = springs.direction[s];
        const double pull =
            springs.weight[s] * glm::dot(n, inverseRootMass[a] * x[a] - inverseRootMass[b] * x[b]);
        y[a] += inverseRootMass[a] * pull * n;
        y[b] -= inverseRootMass[b] * pull * n;
    }
    if (stiffness.volume.empty())
        return;
    std::vector<glm::dvec3> scaled(x.size()), forces(x.size(), glm::dvec3(0));
    for (std::size_t node = 0; node < x.size(); ++node)
        scaled[node] = inverseRootMass[node] * x[node];
    stiffness.volume.addLinear(scaled, forces, stiffness.cellFactors);
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
double stiffestShare(const Operator& stiffness) {
    const std::size_t count = stiffness.inverseRootMass.size();
    std::vector<glm::dvec3> before(count, glm::dvec3(0)), now(count), next(count);
    std::uint32_t random = 12345;
    for (std::size_t i = 0; i < count; ++i) {
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
        applySymmetric(stiffness, now, next);
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

/// omega^2 of a lone full cell of one material, at its steepest tangent, in units of k/m of material 0.
double loneCellShare(const MaterialShares& material) {
    Eigen::Matrix<double, 24, 24> stiffness = Eigen::Matrix<double, 24, 24>::Zero();
    for (int a = 0; a < 8; ++a)
        for (int d = 0; d < 18; d += 2) {
            if (!((directionsInCell(a) >> d) & 1u))
                continue;
            const glm::ivec3 to = cornerOffset(a) + kNeighbourOffsets[std::size_t(d)];
            const int b = to.x | to.y << 1 | to.z << 2;
            const glm::dvec3 n = glm::normalize(glm::dvec3(kNeighbourOffsets[std::size_t(d)]));
            const double weight = (d < 6 ? 0.25 : 0.5) * material.spring[std::size_t(d / 2)];
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    const double entry = weight * n[i] * n[j];
                    stiffness(3 * a + i, 3 * a + j) += entry;
                    stiffness(3 * b + i, 3 * b + j) += entry;
                    stiffness(3 * a + i, 3 * b + j) -= entry;
                    stiffness(3 * b + i, 3 * a + j) -= entry;
                }
        }
    Eigen::Matrix<double, 24, 1> divergence;
    for (int c = 0; c < 8; ++c)
        for (int i = 0; i < 3; ++i)
            divergence[3 * c + i] = 0.25 * cornerSign(c)[i];
    stiffness += material.bulk * divergence * divergence.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 24, 24>> solver(stiffness,
                                                                              Eigen::EigenvaluesOnly);
    return solver.eigenvalues().maxCoeff() * material.largestTangent() / (material.density / 8);
}

} // namespace

StableStep stableStep(const Lattice& lattice, const Tissue& tissue, double frameTime) {
    StableStep step;
    const double perShare = tissue.stiffnessOverMass(lattice.spacing);
    const TissueField field(lattice, tissue);
    const bool isotropic = tissue.materialCount() == 1 && !tissue.fibrous();
    const bool stiffens = tissue.stiffens();

    std::vector<double> inverseRootMass, tangents; // one a cell
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        inverseRootMass.push_back(1 / std::sqrt(field.massShare(node)));
    double loneCell = 0;
    std::vector<bool> seen(field.materials().size(), false);
    for (std::size_t cell = 0; cell < lattice.cells.size(); ++cell) {
        const MaterialShares& material = field.materialOf(cell);
        if (stiffens)
            tangents.push_back(material.largestTangent());
        if (!seen[lattice.cells[cell].material])
            loneCell = std::max(loneCell, loneCellShare(material));
        seen[lattice.cells[cell].material] = true;
    }
    const double bulk = isotropic ? tissue.bulkShare() : 0;
    const double tangent = isotropic ? field.materials().front().largestTangent() : 1;
    const auto rate = [&](const SpringList& springs, const VolumeTerm& volume, double floor) {
        const Operator stiffness{springs, volume, tangents, inverseRootMass};
        return std::clamp(kIterationSlack * stiffestShare(stiffness), isotropic ? floor : 0, loneCell) *
               perShare;
    };

    const SpringList springs =
        collectSprings(lattice, [&](std::size_t node, int d) { return field.springWeight(node, d); });
    step.springRate2 = rate(springs, {}, kEndlessLattice);
    step.formulaRate2 = (kEndlessLattice + kEndlessLatticeBulk * bulk) * tangent * perShare;
    step.stiffestRate2 = step.springRate2;
    if (tissue.needsCellPass()) {
        const SpringList stiffened = collectSprings(
            lattice, [&](std::size_t node, int d) { return field.springWeight(node, d, tangents); });
        step.stiffestRate2 = rate(stiffened, VolumeTerm(lattice, tissue, lattice.connections),
                                  (kEndlessLattice + kEndlessLatticeBulk * bulk) * tangent);
    }
    step.dampingRate = tissue.dampingTime * step.springRate2;
    if (tissue.dampingVaries()) {
        const SpringList dampers =
            collectSprings(lattice, [&](std::size_t node, int d) { return field.dampingWeight(node, d); });
        step.dampingRate =
            kIterationSlack * stiffestShare({dampers, {}, tangents, inverseRootMass}) * perShare;
    }
    // Increments lag half a step, so damping lowers the bound: dt^2 omega^2 + 2 dt delta < 4, delta the
    // largest rate of M^-1 C (tau omega_s^2 of the springs' share where tau is one for all). The stiffest
    // modes of both are nearly the same (see above), so the sum of the two largest rates is hardly more than
    // the largest of the sum. Air drag acts on the same lagging increments, equally in every mode.
    const double damped = (step.dampingRate + tissue.airDrag) / step.stiffestRate2;
    step.bound = std::sqrt(damped * damped + 4 / step.stiffestRate2) - damped;
    step.margin = kMargin;
    const double steps = std::ceil(frameTime / (kMargin * step.bound));
    step.stepsPerFrame = steps < kMostSteps ? int(steps) : int(kMostSteps);
    step.timeStep = frameTime / step.stepsPerFrame;
    return step;
}

double implicitToolSpeed(double spacing, double timeStep) {
    return kImplicitWay * spacing / timeStep;
}

int implicitStepsPerFrame(const std::vector<Tool>& tools, double spacing, double frameTime) {
    double farthest = 0; // m in a frame, of any point of a tool
    for (const Tool& tool : tools)
        for (std::size_t i = 1; i < tool.keys.size(); ++i) {
            const ToolKey &a = tool.keys[i - 1], &b = tool.keys[i];
            double way = glm::distance(a.at, b.at);
            if (a.turn != b.turn && tool.shape.kind != ShapeKind::halfSpace)
                way += 2 * std::acos(std::min(1.0, std::abs(glm::dot(a.turn, b.turn)))) *
                       boundingRadius(tool.wholeShape());
            farthest = std::max(farthest, way * std::min(1.0, frameTime / (b.time - a.time)));
        }
    const double steps = std::ceil(farthest / (kImplicitWay * spacing) - 1e-6);
    return int(std::clamp(steps, 1.0, double(kMostImplicitSteps)));
}

} // namespace serosa::sim
