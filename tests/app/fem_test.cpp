// The finite elements that the lattice is compared with, against what is known without them: uniform strain,
// rigid motions, beam theory and convergence; and the solids that they are made of.

#include "app/verify/fem_comparison.h"
#include "app/verify/fem_solid.h"
#include "app/verify/plane_cut.h"
#include "app/verify/tet_mesh.h"
#include "models/phantom.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace serosa::app {
namespace {

using Vector = Eigen::VectorXd;

constexpr ElasticSolid kSolid{5000, 0.25};

/// A box of cells, each cut into six tetrahedra around its diagonal; inner corners are moved by up to
/// `disorder` of a cell.
TetMesh boxOfTets(const glm::ivec3& cells, const glm::dvec3& size, double disorder) {
    std::mt19937 random(5);
    const auto index = [&](const glm::ivec3& p) {
        return std::uint32_t((p.z * (cells.y + 1) + p.y) * (cells.x + 1) + p.x);
    };
    std::vector<glm::dvec3> corners;
    std::vector<std::array<std::uint32_t, 4>> tets;
    for (int z = 0; z <= cells.z; ++z)
        for (int y = 0; y <= cells.y; ++y)
            for (int x = 0; x <= cells.x; ++x) {
                glm::dvec3 p = glm::dvec3(x, y, z);
                const bool inner = x > 0 && y > 0 && z > 0 && x < cells.x && y < cells.y && z < cells.z;
                for (int axis = 0; axis < 3; ++axis) {
                    const double shift = double(random()) / 4294967296.0 - 0.5;
                    p[axis] += inner ? 2 * disorder * shift : 0;
                }
                corners.push_back(p * size / glm::dvec3(cells));
            }
    constexpr int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x)
                for (const auto& axes : order) {
                    glm::ivec3 p(x, y, z);
                    std::array<std::uint32_t, 4> tet{index(p)};
                    for (std::size_t i = 0; i < 3; ++i) {
                        ++p[axes[i]];
                        tet[i + 1] = index(p);
                    }
                    tets.push_back(tet);
                }
    return quadraticTets(std::move(corners), tets);
}

Vector fieldOn(const TetMesh& mesh, const glm::dmat3& slope, const glm::dvec3& shift) {
    Vector field(Eigen::Index(3 * mesh.nodes.size()));
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
        const glm::dvec3 u = slope * mesh.nodes[node] + shift;
        for (int i = 0; i < 3; ++i)
            field[Eigen::Index(3 * node) + i] = u[i];
    }
    return field;
}

bool onBox(const glm::dvec3& p, const glm::dvec3& size) {
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < 1e-12 || p[axis] > size[axis] - 1e-12)
            return true;
    return false;
}

TEST(FemSolid, PatchTestUniformStrainIsExact) {
    const glm::dvec3 size(0.03, 0.02, 0.025);
    const TetMesh mesh = boxOfTets({3, 3, 3}, size, 0.15);
    const glm::dmat3 slope(1e-3, 2e-4, -3e-4, 5e-4, -7e-4, 1e-4, 2e-4, 6e-4, 9e-4);
    const Vector exact = fieldOn(mesh, slope, {1e-4, 0, -2e-4});
    std::vector<bool> held;
    for (const glm::dvec3& node : mesh.nodes)
        held.push_back(onBox(node, size));
    ASSERT_GT(std::count(held.begin(), held.end(), false), 50);
    const FemMatrix stiffness = femStiffness(mesh, kSolid);
    // In equilibrium inside, and found again from the boundary alone.
    const Vector forces = stiffness * exact;
    double inner = 0;
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
        if (!held[node])
            inner = std::max(inner, forces.segment<3>(Eigen::Index(3 * node)).norm());
    EXPECT_LT(inner / forces.cwiseAbs().maxCoeff(), 1e-12);
    const Result<Vector> found = solveFem(mesh, stiffness, Vector::Zero(exact.size()), held, exact, 1e-14);
    ASSERT_TRUE(found.ok());
    EXPECT_LT((found.value() - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff(), 1e-10);

    // Energy of the strain, in closed form.
    const glm::dmat3 strain = 0.5 * (slope + glm::transpose(slope));
    double trace = 0, squares = 0;
    for (int i = 0; i < 3; ++i) {
        trace += strain[i][i];
        for (int j = 0; j < 3; ++j)
            squares += strain[i][j] * strain[i][j];
    }
    const double energy =
        (0.5 * kSolid.lambda() * trace * trace + kSolid.mu() * squares) * size.x * size.y * size.z;
    EXPECT_NEAR(0.5 * exact.dot(forces) / energy, 1, 1e-12);
    EXPECT_NEAR(mesh.volume() / (size.x * size.y * size.z), 1, 1e-12);
}

TEST(FemSolid, RigidMotionsGiveNoForce) {
    const TetMesh mesh = boxOfTets({2, 3, 2}, {0.02, 0.03, 0.02}, 0.2);
    const FemMatrix stiffness = femStiffness(mesh, kSolid);
    const double scale = stiffness.diagonal().maxCoeff();
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 direction(0);
        direction[axis] = 1;
        EXPECT_LT((stiffness * fieldOn(mesh, glm::dmat3(0), direction)).cwiseAbs().maxCoeff(), 1e-12 * scale);
        const glm::dmat3 turn(glm::cross(direction, glm::dvec3(1, 0, 0)),
                              glm::cross(direction, glm::dvec3(0, 1, 0)),
                              glm::cross(direction, glm::dvec3(0, 0, 1)));
        EXPECT_LT((stiffness * fieldOn(mesh, turn, {})).cwiseAbs().maxCoeff(), 1e-12 * scale);
    }
    EXPECT_LT((FemMatrix(stiffness.transpose()) - stiffness).norm(), 1e-12 * stiffness.norm());
}

TEST(FemSolid, BodyForcesAddUpToTheWeight) {
    const TetMesh mesh = boxOfTets({2, 2, 2}, {0.01, 0.02, 0.03}, 0.2);
    const Vector forces = bodyForces(mesh, {1, -2, 3});
    glm::dvec3 sum(0);
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
        sum += glm::dvec3(forces[Eigen::Index(3 * node)], forces[Eigen::Index(3 * node) + 1],
                          forces[Eigen::Index(3 * node) + 2]);
    EXPECT_LT(glm::distance(sum, 6e-6 * glm::dvec3(1, -2, 3)), 1e-18);
}

/// Sag of a clamped bar's end under its weight over Timoshenko's.
double sagShare(int cellsAcross) {
    const double length = 0.12, side = 0.01, load = 1000; // m, m, N/m3
    const TetMesh mesh = boxOfTets({12 * cellsAcross, cellsAcross, cellsAcross}, {length, side, side}, 0);
    std::vector<bool> held;
    for (const glm::dvec3& node : mesh.nodes)
        held.push_back(node.x < 1e-12);
    const Vector moved =
        solveFem(mesh, femStiffness(mesh, kSolid), bodyForces(mesh, {0, -load, 0}), held).value();
    double sag = 0, count = 0;
    for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
        if (mesh.nodes[node].x > length - 1e-12) {
            sag -= moved[Eigen::Index(3 * node) + 1];
            ++count;
        }
    const double area = side * side, inertia = area * area / 12, q = load * area;
    const double kappa = 10 * (1 + kSolid.poisson) / (12 + 11 * kSolid.poisson);
    return sag / count /
           (q * std::pow(length, 4) / (8 * kSolid.young * inertia) +
            q * length * length / (2 * kappa * kSolid.mu() * area));
}

TEST(FemSolid, CantileverSagsAsBeamTheorySays) {
    const double coarse = sagShare(1), fine = sagShare(2);
    EXPECT_NEAR(fine, 1, 0.01);
    EXPECT_LT(coarse, fine); // displacement elements are too stiff, and less so when finer
    EXPECT_GT(coarse, 0.9);
}

/// A field that the elements cannot hold: u = (sin, 0, 0); the energy of its interpolation falls to the true
/// one with the fourth power of the size of an element.
TEST(FemSolid, EnergyConvergesWithTheFourthOrder) {
    const double side = 0.01, pi = 3.141592653589793;
    std::vector<double> errors;
    for (const int cells : {4, 8}) {
        const TetMesh mesh = boxOfTets({cells, cells, cells}, glm::dvec3(side), 0);
        Vector field = Vector::Zero(Eigen::Index(3 * mesh.nodes.size()));
        for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
            field[Eigen::Index(3 * node)] = 1e-5 * std::sin(pi * mesh.nodes[node].x / side);
        const double slope = 1e-5 * pi / side;
        const double energy =
            0.5 * (kSolid.lambda() + 2 * kSolid.mu()) * slope * slope / 2 * std::pow(side, 3);
        errors.push_back(std::abs(0.5 * field.dot(femStiffness(mesh, kSolid) * field) / energy - 1));
    }
    EXPECT_LT(errors[1], 1e-3);
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4, 0.3);
}

TEST(FemSolid, NothingHeldIsAnError) {
    const TetMesh mesh = boxOfTets({1, 1, 1}, glm::dvec3(0.01), 0);
    const std::vector<bool> held(mesh.nodes.size(), false);
    EXPECT_FALSE(solveFem(mesh, femStiffness(mesh, kSolid), bodyForces(mesh, {0, 1, 0}), held).ok());
}

TEST(PlaneCut, OfABallHasTheCapsVolume) {
    const sim::TriangleMesh ball = models::phantomInMetres("ball", 5120).value();
    const double radius = ball.highest().y;
    const double height = 0.3 * radius;
    const PlaneCut cut = cutAbove(ball, height).value();
    ASSERT_EQ(cut.loops.size(), 1u);
    for (const std::uint32_t v : cut.loops[0]) {
        EXPECT_EQ(cut.above.positions[v].y, height);
        EXPECT_NEAR(std::hypot(cut.above.positions[v].x, cut.above.positions[v].z), 0.953939 * radius,
                    0.01 * radius);
    }
    const double cap = 3.141592653589793 * std::pow(0.7 * radius, 2) * (3 * radius - 0.7 * radius) / 3;
    EXPECT_NEAR(cut.volume() / cap, 1, 0.005);
    for (std::size_t v = 0; v < cut.above.positions.size(); ++v) {
        EXPECT_GE(cut.above.positions[v].y, height);
        if (cut.sources[v] >= 0) {
            EXPECT_EQ(cut.above.positions[v], cut.whole.positions[std::size_t(cut.sources[v])]);
        }
    }
    EXPECT_FALSE(cutAbove(ball, 2 * radius).ok());
}

TEST(Tetgen, FillsACutBallWithElementsOfTheAskedSize) {
    if (!tetgenExists())
        GTEST_SKIP() << "tetgen is not in PATH";
    const sim::TriangleMesh ball = models::phantomInMetres("ball", 1280).value();
    const PlaneCut cut = cutAbove(ball, 0).value();
    const double largest = std::pow(0.008, 3) / 8.5;
    const TetMesh mesh = fillWithTets(cut, largest, 60).value();
    EXPECT_NEAR(mesh.volume() / cut.volume(), 1, 1e-9);
    double plane = 0; // area of the corners' faces in the plane: a whole disc
    for (std::size_t element = 0; element < mesh.elements.size(); ++element) {
        EXPECT_GT(mesh.volume(element), 0);
        EXPECT_LE(mesh.volume(element), 1.5 * largest); // smoothing moves nodes after the last check
        std::vector<glm::dvec3> low;
        for (std::size_t i = 0; i < 4; ++i)
            if (mesh.nodes[mesh.elements[element][i]].y < 1e-9)
                low.push_back(mesh.nodes[mesh.elements[element][i]]);
        if (low.size() == 3)
            plane += 0.5 * glm::length(glm::cross(low[1] - low[0], low[2] - low[0]));
    }
    EXPECT_LE(mesh.volume() / double(mesh.elements.size()), largest);
    const double radius = ball.highest().y;
    EXPECT_NEAR(plane / (3.141592653589793 * radius * radius), 1, 0.02);
    for (std::size_t v = 0; v < cut.above.positions.size(); ++v)
        EXPECT_EQ(mesh.nodes[v], cut.above.positions[v]);
}

TEST(Tetgen, BadSurfaceIsAnErrorOfTheChild) {
    if (!tetgenExists())
        GTEST_SKIP() << "tetgen is not in PATH";
    PlaneCut cut = cutAbove(models::phantomInMetres("ball", 1280).value(), 0).value();
    cut.above.positions[cut.above.positions.size() / 2] += glm::dvec3(0, 0.5, 0); // a spike through the rest
    cut.above.positions[cut.above.positions.size() / 3] -= glm::dvec3(0.3, 0.5, 0.2);
    const Result<TetMesh> mesh = fillWithTets(cut, 1e-6, 60);
    ASSERT_FALSE(mesh.ok());
    EXPECT_EQ(mesh.error().exitCode, exitChildFailed) << mesh.error().message;
}

TEST(LatticeField, IsTrilinear) {
    const std::vector<sim::LatticeCell> cells{{{0, 0, 0}, 255}, {{1, 0, 0}, 255}, {{2, 0, 0}, 255}};
    const sim::Lattice lattice = sim::latticeFromCells(cells, 0.002, {0.1, 1.2, -0.3});
    const glm::dmat3 slope(0.1, 0.2, 0.3, -0.4, 0.5, 0.6, 0.7, -0.8, 0.9);
    LatticeField field{&lattice, {}};
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        field.displacements.push_back(slope * lattice.toWorld(lattice.restPosition(node)));
    const glm::dvec3 p = lattice.toWorld(glm::dvec3(1.3, 0.4, 0.9) - glm::dvec3(lattice.centre));
    EXPECT_LT(glm::distance(field.at(p), slope * p), 1e-14);
}

} // namespace
} // namespace serosa::app
