#pragma once
// What the tests of coupled organs share: organs with a solver each, and what they have of momentum, energy
// and place.

#include "sim/cpu_solver.h"
#include "sim/organ_group.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <memory>

namespace serosa::test {

inline sim::Lattice latticeOf(const sim::TriangleMesh& mesh, double spacing) {
    sim::LatticeRequest request;
    request.spacing = spacing;
    auto lattice = sim::buildLattice(mesh, request);
    EXPECT_TRUE(lattice.ok());
    return std::move(lattice).value();
}

inline sim::Lattice ballLattice(double radius, double spacing, const glm::dvec3& centre) {
    sim::TriangleMesh mesh = ballMesh(radius, 5);
    for (glm::dvec3& p : mesh.positions)
        p += centre;
    return latticeOf(mesh, spacing);
}

inline sim::Lattice boxLattice(const glm::dvec3& low, const glm::dvec3& high, double spacing) {
    return latticeOf(boxMesh(low, high), spacing);
}

/// An organ: lattice, setup, solver. Neither copied nor moved: the setup points at the lattice.
struct TestOrgan {
    sim::Lattice lattice;
    sim::SolverSetup setup;
    std::unique_ptr<sim::Solver> solver;

    explicit TestOrgan(sim::Lattice given) : lattice(std::move(given)) { setup.lattice = &lattice; }
    TestOrgan(const TestOrgan&) = delete;
    TestOrgan& operator=(const TestOrgan&) = delete;

    template <class Inside>
    void fix(const Inside& inside) { // by place at rest, m
        setup.fixed.clear();
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            setup.fixed.push_back(inside(lattice.toWorld(lattice.restPosition(node))));
    }
    /// Rest, moving at a velocity, m/s.
    void start(const glm::dvec3& velocity) const {
        sim::LatticeState state = sim::startState(setup);
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            if (setup.fixed.empty() || !setup.fixed[node])
                state.increments[node] += velocity * (setup.timeStep / lattice.spacing);
        solver->setState(state);
    }
    double mass(std::size_t node) const {
        return setup.tissue.nodeMass(lattice.spacing) * lattice.massShare(node);
    }
    glm::dvec3 momentum() const { // kg m/s
        const sim::LatticeState state = solver->state();
        glm::dvec3 sum(0);
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
            sum += mass(node) * state.increments[node];
        return sum * (lattice.spacing / setup.timeStep);
    }
    glm::dvec3 centre() const { // m, of mass
        const sim::LatticeState state = solver->state();
        glm::dvec3 sum(0);
        double all = 0;
        for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
            sum += mass(node) * state.positions[node];
            all += mass(node);
        }
        return lattice.toWorld(sum / all);
    }
    double energy() const { // J, kinetic and elastic
        const sim::Energies e = sim::energies(setup, solver->state());
        return e.kinetic + e.elastic;
    }
};

/// One time step for all, of the one that needs the shortest.
inline void stepTogether(std::initializer_list<TestOrgan*> organs) {
    double shortest = 1;
    for (const TestOrgan* organ : organs)
        shortest =
            std::min(shortest, sim::stableStep(organ->lattice, organ->setup.tissue, 1.0 / 60).timeStep);
    for (TestOrgan* organ : organs)
        organ->setup.timeStep = shortest;
}

enum class Kind { reference, cpu, fragment, compute }; // the last two need a context

inline void makeSolvers(std::initializer_list<TestOrgan*> organs, Kind kind) {
    for (TestOrgan* organ : organs)
        switch (kind) {
        case Kind::reference:
            organ->solver = sim::makeReferenceSolver(organ->setup);
            break;
        case Kind::cpu:
            organ->solver = sim::makeCpuSolver(organ->setup);
            break;
        case Kind::fragment:
            organ->solver = std::move(sim::makeFragmentSolver(organ->setup)).value();
            break;
        case Kind::compute:
            organ->solver = std::move(sim::makeComputeSolver(organ->setup)).value();
        }
}

inline std::unique_ptr<sim::OrganGroup> groupOf(std::initializer_list<TestOrgan*> organs, double friction = 0,
                                                std::vector<sim::TiedThread> threads = {},
                                                bool touches = true) {
    std::vector<sim::GroupMember> members;
    for (TestOrgan* organ : organs)
        members.push_back({organ->solver.get(), touches, false});
    return std::move(sim::OrganGroup::create(members, {friction, std::move(threads)})).value();
}

} // namespace serosa::test
