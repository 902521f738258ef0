// What an application does with the libraries: a mesh, its lattice, a solver. The ball hangs in free fall,
// whose path is known; the hash of the state is printed.

#include "models/phantom.h"
#include "sim/lattice.h"
#include "sim/solver.h"

#include <cmath>
#include <cstdio>

int main() {
    auto mesh = serosa::models::makePhantom("ball", 500);
    if (!mesh) {
        std::fprintf(stderr, "%s\n", mesh.error().message.c_str());
        return 2;
    }
    for (glm::dvec3& position : mesh->positions)
        position *= 1e-3; // phantoms are in millimetres
    serosa::sim::LatticeRequest request;
    request.nodes = 300;
    const auto lattice = serosa::sim::buildLattice(*mesh, request);
    if (!lattice) {
        std::fprintf(stderr, "%s\n", lattice.error().message.c_str());
        return 2;
    }

    constexpr int kSteps = 100;
    serosa::sim::SolverSetup setup;
    setup.lattice = &*lattice;
    setup.gravity = {0, -9.81, 0};
    setup.timeStep = serosa::sim::stableStep(*lattice, setup.tissue, 1.0 / 60).timeStep;
    const auto solver = serosa::sim::makeReferenceSolver(setup);
    solver->advance(kSteps);
    const serosa::sim::LatticeState state = solver->state();

    double fall = 0; // m, of the mean node: all nodes fall alike
    for (std::size_t i = 0; i < lattice->nodeCount(); ++i)
        fall += (lattice->restPosition(i).y - state.positions[i].y) * lattice->spacing /
                double(lattice->nodeCount());
    // Increments grow by g dt^2 a step: 1 + 2 + ... + n of them.
    const double known = 9.81 * setup.timeStep * setup.timeStep * kSteps * (kSteps + 1) / 2;
    std::printf("%zu nodes fell %.6f mm in %d steps: %s\n", lattice->nodeCount(), fall * 1e3, kSteps,
                state.hash().c_str());
    if (std::abs(fall - known) > 1e-9 * known) {
        std::fprintf(stderr, "expected %.6f mm\n", known * 1e3);
        return 1;
    }
    return 0;
}
