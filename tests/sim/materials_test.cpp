// Several materials, stiffening and fibres: forces are those of the energies, momenta are kept, curves and
// moduli come out as given, and the step stays below the bound.
#include "shaders/shared_constants.h"
#include "sim/fibre_springs.h"
#include "sim/solver.h"
#include "sim/stiffening.h"
#include "sim/tissue_field.h"
#include "tests/sim/materials.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;
using sim::Tissue;

namespace {

SolverSetup setupOf(const Lattice& lattice, const Tissue& tissue) {
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue = tissue;
    setup.timeStep = sim::stableStep(lattice, tissue, 1).timeStep;
    return setup;
}

std::vector<glm::dvec3> disturbed(const Lattice& lattice, double size, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto one = [&random, size] { return size * (double(random()) / 2147483648.0 - 1); };
    std::vector<glm::dvec3> positions = sim::restState(lattice).positions;
    for (glm::dvec3& x : positions)
        for (int axis = 0; axis < 3; ++axis)
            x[axis] += one();
    return positions;
}

/// Forces of the reference solver, N: what one step gives to bodies at rest.
std::vector<glm::dvec3> forces(const SolverSetup& setup, const LatticeState& state) {
    const auto solver = sim::makeReferenceSolver(setup);
    solver->setState(state);
    solver->advance(1);
    const double unit = setup.tissue.nodeMass(setup.lattice->spacing) * setup.lattice->spacing /
                        (setup.timeStep * setup.timeStep);
    const sim::TissueField field(*setup.lattice, setup.tissue);
    std::vector<glm::dvec3> result = solver->state().increments;
    for (std::size_t node = 0; node < result.size(); ++node)
        result[node] *= field.massShare(node) * unit;
    return result;
}

/// Elastic energy density of a block of one material under a uniform strain, Pa.
double density(const Tissue& tissue, const glm::dmat3& strain) {
    const Lattice lattice = test::blockLattice(3, 3, 3);
    LatticeState state = sim::restState(lattice);
    for (glm::dvec3& x : state.positions)
        x += strain * x;
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue = tissue;
    setup.timeStep = 1; // nothing moves
    return sim::energies(setup, state).elastic / (27 * std::pow(lattice.spacing, 3));
}

/// Compliance in Voigt's order from energies of small strains.
Eigen::Matrix<double, 6, 6> compliance(const Tissue& tissue) {
    const auto strainOf = [](int i) {
        glm::dmat3 strain(0);
        const double size = 1e-5;
        if (i < 3)
            strain[i][i] = size;
        else
            strain[(i - 2) % 3][(i - 1) % 3] = strain[(i - 1) % 3][(i - 2) % 3] = size / 2;
        return strain;
    };
    Eigen::Matrix<double, 6, 6> stiffness;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            stiffness(i, j) =
                (density(tissue, strainOf(i) + strainOf(j)) - density(tissue, strainOf(i) - strainOf(j))) /
                (2 * 1e-10);
    return stiffness.inverse();
}

double youngAlong(const Eigen::Matrix<double, 6, 6>& compliance, const glm::dvec3& direction) {
    const glm::dvec3 n = glm::normalize(direction);
    Eigen::Matrix<double, 6, 1> stress;
    stress << n.x * n.x, n.y * n.y, n.z * n.z, n.y * n.z, n.z * n.x, n.x * n.y;
    return 1 / stress.dot(compliance * stress);
}

} // namespace

TEST(TissueField, oneMaterialHasTheLatticesOwnWeights) {
    const Lattice lattice = test::raggedLattice(3, 5);
    const sim::TissueField field(lattice, {});
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        EXPECT_EQ(field.massShare(node), lattice.massShare(node));
        for (int d = 0; d < 18; ++d)
            EXPECT_EQ(field.springWeight(node, d), lattice.springWeight(node, d));
    }
}

TEST(TissueField, bothEndsOfASpringAgreeAndSumTheirCells) {
    const Lattice lattice = test::patchedLattice(5);
    const sim::TissueField field(lattice, test::threeMaterials());
    double springs = 0, mass = 0, expectedSprings = 0, expectedMass = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        mass += field.massShare(node);
        for (int d = 0; d < 18; ++d) {
            const std::int64_t other = lattice.neighbour(node, d);
            if (other < 0)
                continue;
            springs += field.springWeight(node, d) / 2;
            EXPECT_EQ(field.springWeight(node, d), field.springWeight(std::size_t(other), d ^ 1));
            EXPECT_EQ(field.dampingWeight(node, d), field.dampingWeight(std::size_t(other), d ^ 1));
        }
    }
    for (const sim::LatticeCell& cell : lattice.cells) {
        const sim::MaterialShares& material = field.materials()[cell.material];
        expectedMass += cell.fill / 255.0 * material.density;
        for (std::size_t pair = 0; pair < 9; ++pair) // 4 edges f k/4, 2 diagonals f k/2 a direction
            expectedSprings += cell.fill / 255.0 * material.spring[pair];
    }
    EXPECT_NEAR(mass, expectedMass, 1e-10 * mass);
    EXPECT_NEAR(springs, expectedSprings, 1e-10 * springs);
}

TEST(Materials, forceIsTheDerivativeOfTheEnergy) {
    const Lattice lattice = test::patchedLattice(6);
    const SolverSetup setup = setupOf(lattice, test::threeMaterials());
    LatticeState state = sim::restState(lattice), moved = state;
    state.positions = disturbed(lattice, 0.05, 2);
    const std::vector<glm::dvec3> force = forces(setup, state), way = disturbed(lattice, 1, 3);
    const auto energyAt = [&](double step) {
        for (std::size_t i = 0; i < way.size(); ++i)
            moved.positions[i] = state.positions[i] + step * (way[i] - lattice.restPosition(i));
        return sim::energies(setup, moved).elastic;
    };
    double work = 0;
    for (std::size_t i = 0; i < way.size(); ++i)
        work += glm::dot(force[i], way[i] - lattice.restPosition(i)) * lattice.spacing;
    const double slope = (energyAt(1e-6) - energyAt(-1e-6)) / 2e-6;
    EXPECT_NEAR(slope, -work, 1e-5 * std::abs(slope));
    EXPECT_GT(std::abs(slope), 1e-6);
}

TEST(Materials, forcesKeepBothMomentaWhateverTheStateAndTheCuts) {
    const Lattice lattice = test::patchedLattice(7);
    const SolverSetup setup = setupOf(lattice, test::threeMaterials());
    LatticeState state = sim::restState(lattice);
    state.positions = disturbed(lattice, 0.8, 4); // cells upside down among them
    for (const bool cut : {false, true}) {
        if (cut) {
            state.connections = lattice.connections;
            for (std::size_t node = 0; node < lattice.nodeCount(); node += 3)
                for (int d = 0; d < 18; d += 4)
                    if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                        state.connections[node] &= ~(1u << d);
                        state.connections[std::size_t(other)] &= ~(1u << (d ^ 1));
                    }
        }
        const std::vector<glm::dvec3> force = forces(setup, state);
        glm::dvec3 sum(0), torque(0);
        double size = 0;
        for (std::size_t i = 0; i < force.size(); ++i) {
            sum += force[i];
            torque += glm::cross(state.positions[i], force[i]);
            size += glm::length(force[i]);
        }
        EXPECT_LT(glm::length(sum), 1e-12 * size) << cut;
        EXPECT_LT(glm::length(torque), 1e-11 * size) << cut;
    }
}

TEST(Stiffening, energyUnderTensionIsTheAreaUnderTheCurve) {
    for (const double poisson : {0.25, 0.45}) {
        // Turns at strains so small that geometry is linear.
        Tissue tissue;
        tissue.poisson = poisson;
        tissue.young = 1000;
        tissue.curve = {{1e-4, 0.1}, {2e-4, 0.4}, {4e-4, 2}};
        tissue.strainLimit = 5e-4;
        const double limit = 2 + 1e-4 * 8000; // Pa, at the strain limit; ten times 8 kPa beyond it
        for (const auto& [strain, area] : {std::pair{5e-5, 0.5 * 5e-5 * 0.05},
                                           {2e-4, 0.5 * 1e-4 * 0.1 + 1e-4 * 0.25},
                                           {4e-4, 0.5 * 1e-4 * 0.1 + 1e-4 * 0.25 + 2e-4 * 1.2},
                                           {6e-4, 0.5 * 1e-4 * 0.1 + 1e-4 * 0.25 + 2e-4 * 1.2 +
                                                      1e-4 * 0.5 * (2 + limit) + 1e-4 * (limit + 4)}}) {
            glm::dmat3 tension(0);
            tension[0][0] = strain;
            tension[1][1] = tension[2][2] = -poisson * strain;
            EXPECT_NEAR(density(tissue, tension) / area, 1, 2e-3) << strain;
        }
    }
}

TEST(Stiffening, factorIsTheSecantOfTheCurve) {
    Tissue tissue;
    tissue.young = 2000;
    tissue.curve = {{0.1, 200}, {0.2, 1200}};
    const sim::MaterialShares shares = sim::materialShares(tissue).front();
    EXPECT_DOUBLE_EQ(shares.stiffening(0), 1);
    EXPECT_DOUBLE_EQ(shares.stiffening(0.1), 1);
    EXPECT_NEAR(shares.stiffening(0.15), 700 / (2000 * 0.15), 1e-12);
    EXPECT_NEAR(shares.stiffening(0.3), 2200 / (2000 * 0.3), 1e-12); // beyond the last point, straight on
    EXPECT_NEAR(shares.largestTangent(), 5, 1e-12);
}

TEST(Fibres, alongAxesAndDiagonalsAreThoseOfTheory) {
    for (const glm::dvec3& fibre : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 2), glm::dvec3(0, 1, -1)}) {
        Tissue tissue;
        tissue.young = 3000;
        tissue.poisson = 0.4;
        tissue.fibre = fibre;
        tissue.fibreYoung = 12000;
        const auto s = compliance(tissue);
        EXPECT_NEAR(youngAlong(s, fibre), 12000, 12);
        // Across: S = S0 - C (S0 v)(S0 v)^T / (1 + C v.S0 v), v the fibres' dyad.
        const double c = 9000, e = 3000, nu = 0.4;
        const double across = 1 / (1 / e - c * (nu / e) * (nu / e) / (1 + c / e));
        const glm::dvec3 side =
            glm::cross(glm::normalize(fibre), fibre.x > 0 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
        EXPECT_NEAR(youngAlong(s, side), across, 0.003 * across);
    }
}

TEST(Fibres, haveTheGivenModulusEverywhereAndStiffenLittleAcross) {
    std::mt19937 random(11);
    const auto one = [&random] { return double(random()) / 2147483648.0 - 1; };
    std::vector<double> across; // of young: the stiffer of two directions
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 fibre =
            i == 0 ? glm::dvec3(1, 1, 1) : glm::normalize(glm::dvec3(one(), one(), one()));
        Tissue tissue;
        tissue.young = 3000;
        tissue.poisson = i % 2 ? 0.45 : 0.25;
        tissue.fibre = fibre;
        tissue.fibreYoung = 12000;
        const auto s = compliance(tissue);
        EXPECT_NEAR(youngAlong(s, fibre), 12000, 12);
        const glm::dvec3 side = glm::normalize(
            glm::cross(fibre, std::abs(fibre.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        const glm::dvec3 other = glm::cross(glm::normalize(fibre), side);
        across.push_back(std::max(youngAlong(s, side), youngAlong(s, other)) / 3000);
        for (const double constant : sim::fibreSprings(fibre, 3000, tissue.poisson, 12000))
            EXPECT_GE(constant, 0);
    }
    std::sort(across.begin(), across.end());
    EXPECT_LE(across[across.size() / 2], 1.25); // sim/fibre_springs.h
    EXPECT_LE(across.back(), 2);
}

TEST(StableStep, ofSeveralMaterialsIsNeverAboveTheTrueBoundNorFarBelow) {
    double least = 10, largest = 0;
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        const Lattice lattice = test::patchedLattice(seed, 3);
        Tissue tissue = test::threeMaterials();
        tissue.curve.clear();
        tissue.strainLimit = 0;
        for (sim::Material& material : tissue.others) {
            material.curve.clear();
            material.strainLimit = 0;
            material.dampingTime = tissue.dampingTime = 0;
        }
        SolverSetup setup = setupOf(lattice, tissue);
        // Columns of the stiffness from the forces of small displacements.
        const sim::TissueField field(lattice, tissue);
        const auto size = Eigen::Index(3 * lattice.nodeCount());
        Eigen::MatrixXd stiffness(size, size), mass = Eigen::MatrixXd::Zero(size, size);
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            for (int axis = 0; axis < 3; ++axis) {
                const Eigen::Index column = Eigen::Index(3 * node) + axis;
                mass(column, column) = field.massShare(node) * tissue.nodeMass(lattice.spacing);
                std::vector<glm::dvec3> sum(lattice.nodeCount(), glm::dvec3(0));
                for (const double sign : {-1.0, 1.0}) {
                    LatticeState state = sim::restState(lattice);
                    state.positions[node][axis] += sign * 1e-5;
                    const std::vector<glm::dvec3> force = forces(setup, state);
                    for (std::size_t i = 0; i < sum.size(); ++i)
                        sum[i] -= sign / (2e-5 * lattice.spacing) * force[i];
                }
                for (std::size_t i = 0; i < sum.size(); ++i)
                    for (int a = 0; a < 3; ++a)
                        stiffness(Eigen::Index(3 * i) + a, column) = sum[i][a];
            }
        stiffness = (0.5 * (stiffness + stiffness.transpose())).eval();
        const double exact = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, mass)
                                 .eigenvalues()
                                 .maxCoeff();
        const sim::StableStep step = sim::stableStep(lattice, tissue, 1);
        const double share = step.bound / (2 / std::sqrt(exact));
        least = std::min(least, share);
        largest = std::max(largest, share);
    }
    EXPECT_LE(largest, 1.0001);
    EXPECT_GE(least, 0.7);
}

TEST(StableStep, holdsABodyOfStiffeningTissueThatIsThrownAbout) {
    const Lattice lattice = test::patchedLattice(9, 4);
    SolverSetup setup = setupOf(lattice, test::threeMaterials());
    const auto solver = sim::makeReferenceSolver(setup);
    LatticeState state = sim::restState(lattice);
    std::mt19937 random(2);
    for (glm::dvec3& u : state.increments)
        for (int axis = 0; axis < 3; ++axis)
            u[axis] = 0.02 * (double(random()) / 2147483648.0 - 1);
    solver->setState(state);
    const sim::Energies before = sim::energies(setup, state);
    for (int i = 0; i < 20; ++i) {
        solver->advance(200);
        const sim::Energies now = sim::energies(setup, solver->state());
        EXPECT_LT(now.kinetic + now.elastic, 1.02 * before.kinetic);
    }
}
