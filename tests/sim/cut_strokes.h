#pragma once
// Bodies and strokes that the tests of cuts share.

#include "sim/solver.h"
#include "tests/sim/shapes.h"

#include <algorithm>
#include <random>

namespace serosa::test {

/// A hollow ball of cells, walls one and two cells thick, so that strokes cut thin remains.
inline sim::Lattice hollowBall(int size = 9) {
    std::vector<sim::LatticeCell> cells;
    const double middle = (size - 1) / 2.0;
    for (int z = 0; z < size; ++z)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const double r = glm::length(glm::dvec3(x, y, z) - middle) / (middle + 0.5);
                if (r < 1 && r > 0.6)
                    cells.push_back({{x, y, z}, std::uint8_t(80 + (x * 7 + y * 5 + z * 3) % 176)});
            }
    return sim::latticeFromCells(cells, 0.003, {0.05, 1.2, -0.3});
}

inline sim::SolverSetup plainSetup(const sim::Lattice& lattice) {
    sim::SolverSetup setup;
    setup.lattice = &lattice;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1.0 / 60).timeStep;
    return setup;
}

inline double number(std::mt19937& random, double low, double high) {
    return low + (high - low) * double(random()) / 4294967296.0;
}

/// A stroke through the lattice's box: mostly twisted, sometimes on lattice planes and through nodes.
inline sim::Stroke randomStroke(const sim::Lattice& lattice, std::mt19937& random, double size = 0.5) {
    const glm::dvec3 half = 0.6 * glm::dvec3(lattice.nodeDims);
    const auto point = [&](const glm::dvec3& around, double reach) {
        const double x = number(random, -reach, reach), y = number(random, -reach, reach),
                     z = number(random, -reach, reach);
        return around + glm::dvec3(x, y, z);
    };
    sim::Stroke stroke;
    const glm::dvec3 x(number(random, -half.x, half.x), number(random, -half.y, half.y),
                       number(random, -half.z, half.z));
    const double reach = size * std::max({half.x, half.y, half.z});
    const bool onLattice = random() % 4 == 0;
    const auto place = [&](glm::dvec3 at) { return lattice.toWorld(onLattice ? glm::round(at) : at); };
    if (random() % 8 == 0) {
        stroke.kind = sim::StrokeKind::cauterize;
        stroke.from[0] = place(x);
        stroke.radius = number(random, 0.2, 1.5) * lattice.spacing;
        return stroke;
    }
    for (glm::dvec3* end : {&stroke.from[0], &stroke.from[1], &stroke.to[0], &stroke.to[1]})
        *end = place(point(x, reach));
    return stroke;
}

inline const std::vector<std::uint32_t>& connectionsOf(const sim::Lattice& lattice,
                                                       const sim::LatticeState& state) {
    return state.connections.empty() ? lattice.connections : state.connections;
}

/// Ends that disagree: i knows j exactly when j knows i.
inline std::size_t unmatchedBits(const sim::Lattice& lattice, const std::vector<std::uint32_t>& connections) {
    std::size_t unmatched = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < 18; ++d) {
            if (!((connections[node] >> d) & 1u))
                continue;
            const std::int64_t other = lattice.neighbour(node, d);
            unmatched += other < 0 || !((connections[std::size_t(other)] >> (d ^ 1)) & 1u);
        }
    return unmatched;
}

/// A plane across x at a lattice coordinate, wider than the body.
inline sim::Stroke fullCut(const sim::Lattice& lattice, double x) {
    const glm::dvec3 far = glm::dvec3(lattice.nodeDims) + 1.0;
    sim::Stroke stroke;
    stroke.from = {lattice.toWorld({x, far.y, -far.z}), lattice.toWorld({x, far.y, far.z})};
    stroke.to = {lattice.toWorld({x, -far.y, -far.z}), lattice.toWorld({x, -far.y, far.z})};
    return stroke;
}

} // namespace serosa::test
