#pragma once
// Bodies that the tests of the implicit step share.

#include "sim/solver.h"
#include "tests/sim/shapes.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace serosa::test {

inline constexpr double kFrame = 1.0 / 60;

inline sim::SolverSetup implicitSetup(const sim::Lattice& lattice, double young) {
    sim::SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue.young = young;
    setup.tissue.dampingTime = 0;
    setup.timeStep = kFrame;
    setup.method = sim::StepMethod::implicit;
    return setup;
}

inline double largestDistance(const sim::LatticeState& a, const sim::LatticeState& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.positions.size(); ++i)
        most = std::max(most, glm::distance(a.positions[i], b.positions[i]));
    return most;
}

inline glm::dvec3 massCentre(const sim::Lattice& lattice, const sim::LatticeState& state) {
    glm::dvec3 sum(0);
    double mass = 0;
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
        sum += lattice.massShare(i) * state.positions[i];
        mass += lattice.massShare(i);
    }
    return sum / mass;
}

inline double totalMass(const sim::SolverSetup& setup) { // kg
    double shares = 0;
    for (std::size_t i = 0; i < setup.lattice->nodeCount(); ++i)
        shares += setup.lattice->massShare(i);
    return shares * setup.tissue.nodeMass(setup.lattice->spacing);
}

/// A block whose surface, for contact, is that of its cells.
inline sim::Lattice block(int nx, int ny, int nz, double spacing) {
    sim::Lattice lattice = blockLattice(nx, ny, nz, spacing);
    lattice.depthSteps.assign(lattice.nodeCount(), 170); // Lattice::restDepth
    return lattice;
}

/// y <= 0 is solid.
inline sim::Body floorOf(double friction) {
    sim::Body body;
    body.name = "floor";
    body.shape.kind = sim::ShapeKind::halfSpace;
    body.shape.radius = 0;
    body.friction = friction;
    return body;
}

inline void fixWhere(sim::SolverSetup& setup, bool (*where)(const glm::ivec3&)) {
    setup.fixed.clear();
    for (const glm::ivec3& node : setup.lattice->nodes)
        setup.fixed.push_back(where(node));
}

/// A ball of tissue of 1 kPa in a capsule one cell thick of 1 MPa.
inline sim::Lattice capsuleLattice(int across) {
    const auto inside = [across](const glm::ivec3& cell) {
        const glm::dvec3 from = (glm::dvec3(cell) + 0.5) * 2.0 / double(across) - 1.0;
        return glm::dot(from, from) < 1;
    };
    std::vector<sim::LatticeCell> cells;
    for (int i = 0; i < across * across * across; ++i) {
        const glm::ivec3 cell(i % across, i / across % across, i / across / across);
        bool outer = false;
        for (int axis = 0; axis < 3; ++axis)
            for (const int step : {-1, 1}) {
                glm::ivec3 beside = cell;
                beside[axis] += step;
                outer = outer || !inside(beside);
            }
        if (inside(cell))
            cells.push_back({cell, 255, std::uint8_t(outer ? 1 : 0)});
    }
    return sim::latticeFromCells(cells, 0.06 / across, glm::dvec3(0));
}

inline sim::SolverSetup capsuleSetup(const sim::Lattice& lattice) {
    sim::SolverSetup setup = implicitSetup(lattice, 1000);
    setup.tissue.dampingTime = 0.0005;
    sim::Material capsule = setup.tissue;
    capsule.young = 1e6;
    setup.tissue.others = {capsule};
    setup.gravity = {0, -9.81, 0};
    fixWhere(setup, [](const glm::ivec3& node) { return node.y <= 2; });
    return setup;
}

} // namespace serosa::test
