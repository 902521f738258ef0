#pragma once
// An organ on two or three levels of detail for tests.

#include "sim/lod.h"
#include "sim/solver.h"
#include "tests/sim/shapes.h"

#include <memory>
#include <vector>

namespace serosa::test {

/// Lattices of spacing h, 2h, 4h with nested grids, and their setups.
struct Levels {
    std::vector<std::unique_ptr<sim::Lattice>> lattices;
    std::vector<sim::SolverSetup> setups;

    Levels(const sim::TriangleMesh& metres, double spacing, const sim::SolverSetup& plain,
           double frameTime = 1.0 / 60) {
        for (int level = 0; level < sim::kMostLevels; ++level) {
            sim::LatticeRequest request;
            request.spacing = spacing * (1 << level);
            if (level > 0)
                request.gridPoint = lattices[0]->toWorld(-glm::dvec3(lattices[0]->centre));
            lattices.push_back(std::make_unique<sim::Lattice>(sim::buildLattice(metres, request).value()));
            sim::SolverSetup setup = plain;
            setup.lattice = lattices.back().get();
            if (level > 0)
                setup.tissue = sim::matchedTissue(plain.tissue, *lattices[0], *lattices.back());
            setup.timeStep = sim::stableStep(*setup.lattice, setup.tissue, frameTime).timeStep;
            setups.push_back(setup);
        }
    }
    /// Fixes what rests below y, m, on every level.
    void fixBelow(double y) {
        for (sim::SolverSetup& setup : setups) {
            setup.fixed.clear();
            for (std::size_t node = 0; node < setup.lattice->nodeCount(); ++node)
                setup.fixed.push_back(setup.lattice->toWorld(setup.lattice->restPosition(node)).y < y);
        }
    }
};

/// A ball with a dented side: nothing about it is symmetric to the grid.
inline sim::TriangleMesh dentedBall(double radius) {
    sim::TriangleMesh mesh = ballMesh(radius, 5);
    for (glm::dvec3& p : mesh.positions) {
        const glm::dvec3 n = p / radius;
        p *= 1 - 0.25 * std::exp(-8 * (1 - n.x)) + 0.1 * n.y * n.z;
        p += glm::dvec3(0.013, 1.1, -0.2);
    }
    return mesh;
}

} // namespace serosa::test
