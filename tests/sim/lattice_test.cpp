// Topology of the cell lattice: counts known in closed form, symmetry of connections, a closed boundary.
#include "sim/lattice.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <map>

using namespace serosa;
using sim::Lattice;

namespace {

std::vector<Lattice> family() {
    std::vector<Lattice> lattices;
    lattices.push_back(test::blockLattice(1, 1, 1));
    lattices.push_back(test::blockLattice(4, 3, 2));
    // Two cells that touch along an edge only, and a ring of cells.
    lattices.push_back(sim::latticeFromCells({{{0, 0, 0}, 255}, {{1, 1, 0}, 100}}, 1, glm::dvec3(0)));
    std::vector<sim::LatticeCell> ring;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
            if (x != 1 || y != 1)
                ring.push_back({{x, y, 0}, std::uint8_t(10 * (x + 3 * y) + 5)});
    lattices.push_back(sim::latticeFromCells(ring, 1, glm::dvec3(0)));
    sim::LatticeRequest request;
    request.nodes = 1500;
    lattices.push_back(sim::buildLattice(test::ballMesh(0.04, 4), request).value());
    return lattices;
}

} // namespace

TEST(Lattice, blockHasAllNodesSpringsAndFaces) {
    const Lattice lattice = test::blockLattice(4, 3, 2);
    EXPECT_EQ(lattice.nodeCount(), 5u * 4 * 3);
    EXPECT_EQ(lattice.boundary.size(), 2u * 2 * (4 * 3 + 3 * 2 + 4 * 2));
    std::size_t springs = 0;
    for (std::uint32_t bits : lattice.connections)
        springs += std::size_t(__builtin_popcount(bits));
    // Axis springs: 4*4*3 + 5*3*3 + 5*4*2; two diagonals a face of the grid: 4*3*3 + 3*2*5 + 4*2*4 faces.
    EXPECT_EQ(springs / 2, 4u * 4 * 3 + 5 * 3 * 3 + 5 * 4 * 2 + 2 * (4 * 3 * 3 + 3 * 2 * 5 + 4 * 2 * 4));
}

TEST(Lattice, bothEndsOfASpringAgree) {
    for (const Lattice& lattice : family())
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            for (int d = 0; d < 18; ++d) {
                const std::int64_t other = lattice.neighbour(node, d);
                EXPECT_EQ(lattice.springWeight(node, d) > 0, other >= 0);
                if (other < 0)
                    continue;
                EXPECT_EQ(lattice.neighbour(std::size_t(other), d ^ 1), std::int64_t(node));
                EXPECT_EQ(lattice.springWeight(node, d), lattice.springWeight(std::size_t(other), d ^ 1));
            }
}

TEST(Lattice, massSharesAndSpringWeightsAreTheCells) {
    for (const Lattice& lattice : family()) {
        double mass = 0, edges = 0, diagonals = 0, fills = 0;
        for (const sim::LatticeCell& cell : lattice.cells)
            fills += cell.fill / 255.0;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
            mass += lattice.massShare(node);
            for (int d = 0; d < 18; d += 2)
                (d < 6 ? edges : diagonals) += lattice.springWeight(node, d);
        }
        EXPECT_NEAR(mass, fills, 1e-9);          // eight corners of f/8
        EXPECT_NEAR(edges, 3 * fills, 1e-9);     // twelve edges of f/4
        EXPECT_NEAR(diagonals, 6 * fills, 1e-9); // twelve face diagonals of f/2
    }
}

TEST(Lattice, boundaryIsClosedAndEnclosesTheCells) {
    for (const Lattice& lattice : family()) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges; // directed: each must have its reverse
        double volume = 0;
        for (const glm::uvec3& t : lattice.boundary) {
            for (int i = 0; i < 3; ++i) {
                ++edges[{t[i], t[(i + 1) % 3]}];
                --edges[{t[(i + 1) % 3], t[i]}];
            }
            volume += glm::dot(lattice.restPosition(t.x),
                               glm::cross(lattice.restPosition(t.y), lattice.restPosition(t.z))) /
                      6;
            EXPECT_LT(std::min({t.x, t.y, t.z}), lattice.nodeCount());
        }
        for (const auto& [edge, count] : edges)
            EXPECT_EQ(count, 0) << edge.first << "-" << edge.second;
        EXPECT_NEAR(volume, double(lattice.cells.size()), 1e-9);
    }
}

TEST(Lattice, facesAreCutThroughTheirLowestNode) {
    const Lattice lattice = test::blockLattice(3, 3, 3);
    for (std::size_t i = 0; i < lattice.boundary.size(); i += 2) {
        const glm::uvec3 a = lattice.boundary[i], b = lattice.boundary[i + 1];
        const std::uint32_t low = std::min({a.x, a.y, a.z, b.x, b.y, b.z});
        EXPECT_EQ(a.x, low);
        EXPECT_EQ(b.x, low);
        EXPECT_EQ(a.z, b.y); // the other end of the diagonal
    }
}

TEST(Lattice, normalsOfFlatFacesPointOut) {
    const Lattice lattice = test::blockLattice(4, 4, 4);
    const std::vector<glm::dvec3> sums = sim::restNormalSums(lattice);
    const auto inner = std::size_t(lattice.nodeAt({2, 2, 2}));
    const auto top = std::size_t(lattice.nodeAt({2, 4, 2}));
    EXPECT_NEAR(glm::length(sums[inner]), 0, 1e-12);
    EXPECT_GT(glm::length(sums[top]), 0.5);
    EXPECT_NEAR(glm::normalize(sums[top]).y, 1, 1e-12);
}

TEST(Lattice, nodeCountIsMetWithinFivePercent) {
    for (const std::size_t wanted : {500u, 2000u, 20000u}) {
        sim::LatticeRequest request;
        request.nodes = wanted;
        const Lattice lattice = sim::buildLattice(test::ballMesh(0.05, 5), request).value();
        EXPECT_NEAR(double(lattice.nodeCount()) / double(wanted), 1, 0.05);
        double fills = 0;
        for (const sim::LatticeCell& cell : lattice.cells)
            fills += cell.fill / 255.0 * lattice.spacing * lattice.spacing * lattice.spacing;
        EXPECT_NEAR(fills / lattice.exactVolume, 1, 2e-3); // eight-bit fills
    }
}

TEST(Lattice, everyVertexLiesInAMaterialCell) {
    sim::LatticeRequest request;
    request.spacing = 0.006;
    const sim::TriangleMesh ball = test::ballMesh(0.05, 5);
    const Lattice lattice = sim::buildLattice(ball, request).value();
    for (const glm::dvec3& p : ball.positions) {
        const glm::ivec3 cell = glm::ivec3(glm::floor(lattice.toLattice(p) + glm::dvec3(lattice.centre)));
        EXPECT_GE(lattice.nodeAt(cell), 0);
        EXPECT_GE(lattice.nodeAt(cell + 1), 0);
    }
}

TEST(Lattice, restCoordinatesAreWholeNumbersAboutTheCentre) {
    sim::LatticeRequest request;
    request.spacing = 0.01;
    sim::TriangleMesh far = test::boxMesh({1.600, -0.9, 0.8}, {1.700, -0.8, 0.85});
    const Lattice lattice = sim::buildLattice(far, request).value();
    EXPECT_EQ(lattice.nodeDims, glm::ivec3(11, 11, 6));
    const glm::dvec3 back = lattice.toWorld(lattice.restPosition(0));
    EXPECT_NEAR(glm::length(back - glm::dvec3(1.600, -0.9, 0.8)), 0, 1e-12);
    EXPECT_NEAR(glm::length(lattice.toLattice(back) - lattice.restPosition(0)), 0, 1e-9);
}

TEST(Lattice, refusesWhatCannotBe) {
    const sim::TriangleMesh ball = test::ballMesh(0.05, 3);
    sim::LatticeRequest request;
    request.spacing = -0.001;
    EXPECT_FALSE(sim::buildLattice(ball, request).ok());
    request.spacing = 0;
    request.nodes = 3;
    EXPECT_NE(sim::buildLattice(ball, request).error().message.find("at least 8 nodes"), std::string::npos);
    request.spacing = 1e-6; // 1e14 cells
    const Error error = sim::buildLattice(ball, request).error();
    EXPECT_NE(error.message.find("GB"), std::string::npos);
    EXPECT_NE(error.message.find("spacing of at least"), std::string::npos);
    request.spacing = 0.002;
    request.maxBytes = 1000;
    EXPECT_FALSE(sim::buildLattice(ball, request).ok());
    request.spacing = 0;
    request.nodes = 100000;
    EXPECT_FALSE(sim::buildLattice(ball, request).ok());
}
