// The volumetric term: its force is the energy's derivative, it keeps both momenta, it gives the wanted bulk
// modulus, it respects cuts, it never breaks the step bound, and it brings collapsed and inverted cells back.
#include "shaders/shared_constants.h"
#include "sim/cell_volumes.h"
#include "sim/solver.h"
#include "sim/volume_term.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numeric>
#include <random>

using namespace serosa;
using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;
using sim::VolumeTerm;

namespace {

glm::dvec3 randomVector(std::mt19937& random) {
    const auto one = [&random] { return double(random()) / 2147483648.0 - 1; };
    const double x = one(), y = one(), z = one();
    return {x, y, z};
}

Lattice raggedLattice(std::uint32_t seed, int size = 3) {
    std::mt19937 random(seed);
    std::vector<sim::LatticeCell> cells;
    for (int i = 0; i < size * size * size; ++i)
        if (i == 0 || random() % 3)
            cells.push_back({{i % size, i / size % size, i / size / size}, std::uint8_t(1 + random() % 255)});
    return sim::latticeFromCells(cells, 0.003, glm::dvec3(0));
}

sim::Tissue tissueOf(double poisson, bool recovery = false) {
    sim::Tissue tissue;
    tissue.poisson = poisson;
    tissue.recovery = recovery;
    tissue.dampingTime = 0;
    return tissue;
}

std::vector<glm::dvec3> disturbed(const Lattice& lattice, double size, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<glm::dvec3> positions = sim::restState(lattice).positions;
    for (glm::dvec3& x : positions)
        x += size * randomVector(random);
    return positions;
}

double dot(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += glm::dot(a[i], b[i]);
    return sum;
}

SolverSetup setupOf(const Lattice& lattice, const sim::Tissue& tissue) {
    SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue = tissue;
    setup.timeStep = sim::stableStep(lattice, tissue, 1).timeStep;
    return setup;
}

} // namespace

TEST(VolumeTerm, isNothingAtAQuarterAndRefusesNothingElse) {
    const Lattice lattice = test::blockLattice(2, 2, 2);
    EXPECT_TRUE(VolumeTerm(lattice, tissueOf(0.25), lattice.connections).empty());
    EXPECT_FALSE(VolumeTerm(lattice, tissueOf(0.3), lattice.connections).empty());
    EXPECT_FALSE(VolumeTerm(lattice, tissueOf(0.25, true), lattice.connections).empty());
}

TEST(VolumeTerm, forceIsTheDerivativeOfTheEnergy) {
    const Lattice lattice = raggedLattice(4);
    struct Shape {
        glm::dvec3 stretch;
        bool recovery;
    };
    // Small; collapsed (J about 0.2); squeezed flat and drawn wide, where q < 1; inside out and drawn out.
    for (const auto& [stretch, recovery] :
         {Shape{{1, 1, 1}, false}, Shape{{1, 1, 0.2}, true}, Shape{{1.6, 1.5, 0.5}, false},
          Shape{{1.8, 1.8, 0.1}, true}, Shape{{-1.5, 2, 1.5}, true}}) {
        const VolumeTerm term(lattice, tissueOf(recovery ? 0.25 : 0.4, recovery), lattice.connections);
        std::vector<glm::dvec3> x = disturbed(lattice, 0.03, 5);
        for (glm::dvec3& p : x)
            p *= stretch;
        std::vector<glm::dvec3> force(x.size(), glm::dvec3(0)), way = disturbed(lattice, 1, 6), moved = x;
        for (std::size_t i = 0; i < x.size(); ++i)
            way[i] -= lattice.restPosition(i);
        term.addForces(x, force);
        const double step = 1e-5;
        for (std::size_t i = 0; i < x.size(); ++i)
            moved[i] = x[i] + step * way[i];
        const double above = term.energy(moved);
        for (std::size_t i = 0; i < x.size(); ++i)
            moved[i] = x[i] - step * way[i];
        const double slope = (above - term.energy(moved)) / (2 * step);
        EXPECT_NEAR(slope, -dot(force, way), 1e-6 * std::abs(slope)) << stretch.x << " " << recovery;
        EXPECT_GT(std::abs(slope), 1e-3);
    }
}

TEST(VolumeTerm, keepsBothMomentaWhateverTheState) {
    const Lattice lattice = raggedLattice(7);
    const VolumeTerm term(lattice, tissueOf(0.49, true), lattice.connections);
    const std::vector<glm::dvec3> x = disturbed(lattice, 0.8, 8); // cells upside down among them
    std::vector<glm::dvec3> force(x.size(), glm::dvec3(0));
    term.addForces(x, force);
    glm::dvec3 sum(0), torque(0);
    double size = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        sum += force[i];
        torque += glm::cross(x[i], force[i]);
        size += glm::length(force[i]);
    }
    EXPECT_GT(size, 1);
    EXPECT_LT(glm::length(sum), 1e-13 * size);
    EXPECT_LT(glm::length(torque), 1e-12 * size);
}

TEST(VolumeTerm, energyOfUniformStrainIsThatOfTheWantedMaterial) {
    for (const double poisson : {0.3, 0.45, 0.49}) {
        const Lattice lattice = raggedLattice(9);
        const sim::Tissue tissue = tissueOf(poisson);
        SolverSetup setup = setupOf(lattice, tissue);
        const double lambda = tissue.young * poisson / ((1 + poisson) * (1 - 2 * poisson)),
                     mu = tissue.young / (2 * (1 + poisson)), h = lattice.spacing;
        double volume = 0;
        for (const sim::LatticeCell& cell : lattice.cells)
            volume += cell.fill / 255.0 * h * h * h;
        const glm::dmat3 strain({1e-4, 4e-5, -3e-5}, {4e-5, -6e-5, 2e-5}, {-3e-5, 2e-5, 5e-5});
        LatticeState state = sim::restState(lattice);
        for (glm::dvec3& x : state.positions)
            x += strain * x;
        double square = 0;
        for (int i = 0; i < 3; ++i)
            square += glm::dot(strain[i], strain[i]);
        const double trace = strain[0][0] + strain[1][1] + strain[2][2];
        const double expected = volume * (0.5 * lambda * trace * trace + mu * square);
        EXPECT_NEAR(sim::energies(setup, state).elastic / expected, 1, 1e-3) << poisson;
    }
}

TEST(VolumeTerm, aCellThatLostAConnectionHasNone) {
    const Lattice lattice = test::blockLattice(2, 1, 1);
    std::vector<std::uint32_t> connections = lattice.connections;
    const auto first = std::size_t(lattice.nodeAt({0, 0, 0})),
               second = std::size_t(lattice.nodeAt({0, 1, 1}));
    connections[first] &= ~(1u << 14); // (0, +, +)
    connections[second] &= ~(1u << 15);
    LatticeState state = sim::restState(lattice);
    for (glm::dvec3& x : state.positions)
        x *= 1.01;
    const sim::Tissue tissue = tissueOf(0.45);
    const double whole = VolumeTerm(lattice, tissue, lattice.connections).energy(state.positions);
    EXPECT_NEAR(VolumeTerm(lattice, tissue, connections).energy(state.positions), whole / 2, 1e-12 * whole);
    // The solver takes them from the state, and gives them back.
    const SolverSetup setup = setupOf(lattice, tissue);
    const auto solver = sim::makeReferenceSolver(setup);
    state.connections = connections;
    solver->setState(state);
    solver->advance(1);
    EXPECT_EQ(solver->state().connections, connections);
    EXPECT_NE(solver->state().increments[first], glm::dvec3(0));
}

TEST(VolumeTerm, tableOfDirectionsInACellIsTheShadersOne) {
    const std::array<std::uint32_t, 8> table = {SRS_IN_CELL_0, SRS_IN_CELL_1, SRS_IN_CELL_2, SRS_IN_CELL_3,
                                                SRS_IN_CELL_4, SRS_IN_CELL_5, SRS_IN_CELL_6, SRS_IN_CELL_7};
    for (int corner = 0; corner < 8; ++corner)
        EXPECT_EQ(sim::directionsInCell(corner), table[std::size_t(corner)]) << corner;
}

TEST(StableStep, withVolumetricTermIsTheDenseEigenvalueAndKeepsTheDampedBound) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const Lattice lattice = raggedLattice(seed);
        sim::Tissue tissue = tissueOf(seed % 3 == 0 ? 0.49 : seed % 3 == 1 ? 0.45 : 0.3);
        tissue.dampingTime = seed % 2 ? 0.0005 : 0;
        const auto size = Eigen::Index(3 * lattice.nodeCount());
        // Columns of the stiffness by the force that the reference solver and the term feel, springs apart.
        Eigen::MatrixXd springs = Eigen::MatrixXd::Zero(size, size), volume = springs, mass = springs;
        const VolumeTerm term(lattice, tissue, lattice.connections);
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
            mass.diagonal().segment<3>(Eigen::Index(3 * node)).setConstant(lattice.massShare(node));
            for (int d = 0; d < 18; ++d)
                if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                    const glm::dvec3 n = glm::normalize(glm::dvec3(sim::kNeighbourOffsets[std::size_t(d)]));
                    const Eigen::Matrix3d block = lattice.springWeight(node, d) *
                                                  Eigen::Vector3d(n.x, n.y, n.z) *
                                                  Eigen::RowVector3d(n.x, n.y, n.z);
                    springs.block<3, 3>(Eigen::Index(3 * node), Eigen::Index(3 * node)) += block;
                    springs.block<3, 3>(Eigen::Index(3 * node), Eigen::Index(3 * other)) -= block;
                }
            for (int axis = 0; axis < 3; ++axis) { // numerical: independent of addLinear
                const double e = 1e-6;
                std::vector<glm::dvec3> x = sim::restState(lattice).positions, plus(x.size(), glm::dvec3(0)),
                                        minus = plus;
                x[node][axis] += e;
                term.addForces(x, plus);
                x[node][axis] -= 2 * e;
                term.addForces(x, minus);
                for (std::size_t i = 0; i < x.size(); ++i)
                    for (int a = 0; a < 3; ++a)
                        volume(Eigen::Index(3 * i) + a, Eigen::Index(3 * node) + axis) =
                            -(plus[i][a] - minus[i][a]) / (2 * e);
            }
        }
        volume = (0.5 * (volume + volume.transpose())).eval();
        const auto largest = [&mass](const Eigen::MatrixXd& matrix) {
            return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, mass)
                .eigenvalues()
                .maxCoeff();
        };
        const sim::StableStep step = sim::stableStep(lattice, tissue, 1);
        const double unit = tissue.stiffnessOverMass(lattice.spacing);
        const double exact = largest(springs + volume);
        EXPECT_GE(step.stiffestRate2 / unit, exact * 0.9999) << seed;
        EXPECT_LE(step.stiffestRate2, std::max(step.formulaRate2, exact * 1.021 * unit)) << seed;
        EXPECT_LE(exact, 20 + 12 * tissue.bulkShare() + 1e-6);
        // The true damped bound: the largest dt with dt^2 K + 2 dt tau K_s < 4 M.
        double low = 0, high = 2 / std::sqrt(exact * unit);
        for (int i = 0; i < 14; ++i) {
            const double dt = 0.5 * (low + high);
            const double rate =
                largest(dt * dt * unit * (springs + volume) + 2 * dt * tissue.dampingTime * unit * springs);
            (rate < 4 ? low : high) = dt;
        }
        EXPECT_LE(step.bound, high) << seed;
        EXPECT_GE(step.bound, 0.7 * low) << seed;
    }
}

TEST(Recovery, changesNothingBelowTwentyPercentStrain) {
    const Lattice lattice = test::blockLattice(3, 3, 3);
    const VolumeTerm term(lattice, tissueOf(0.25, true), lattice.connections);
    std::vector<glm::dvec3> x = sim::restState(lattice).positions;
    for (glm::dvec3& p : x)
        p *= 0.8;
    EXPECT_EQ(term.energy(x), 0);
    for (glm::dvec3& p : x)
        p *= 0.7 / 0.8;
    EXPECT_GT(term.energy(x), 0);
}

TEST(Recovery, cellsTurnedInsideOutComeBackAndDoNotWithoutIt) {
    const Lattice lattice = test::blockLattice(4, 4, 4);
    for (const bool recovery : {false, true}) {
        SolverSetup setup = setupOf(lattice, tissueOf(0.25, recovery));
        setup.tissue.dampingTime = 0.0005;
        setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
        const auto solver = sim::makeReferenceSolver(setup);
        LatticeState state = sim::restState(lattice);
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            state.positions[node].y *= -1; // the mirror image: springs have no energy in it
        solver->setState(state);
        solver->advance(3000);
        const std::vector<double> volumes = sim::cellVolumeRatios(lattice, solver->state());
        const double worst = *std::min_element(volumes.begin(), volumes.end());
        if (recovery)
            EXPECT_GT(worst, 0.9);
        else
            EXPECT_LT(worst, -0.9);
    }
}

TEST(Recovery, scrambledBodiesComeToRest) {
    for (const double poisson : {0.25, 0.45, 0.49})
        for (std::uint32_t seed = 1; seed <= 4; ++seed) {
            const Lattice lattice = test::blockLattice(5, 5, 5);
            SolverSetup setup = setupOf(lattice, tissueOf(poisson, true));
            setup.tissue.dampingTime = 0.0005;
            setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
            const auto solver = sim::makeReferenceSolver(setup);
            LatticeState state = sim::restState(lattice);
            state.positions = disturbed(lattice, 0.7, seed);
            solver->setState(state);
            solver->advance(int(1.0 / setup.timeStep));
            const std::vector<double> volumes = sim::cellVolumeRatios(lattice, solver->state());
            EXPECT_GT(*std::min_element(volumes.begin(), volumes.end()), 0.9) << poisson << " " << seed;
            EXPECT_LT(sim::energies(setup, solver->state()).elastic,
                      1e-3 * sim::energies(setup, state).elastic);
        }
}
