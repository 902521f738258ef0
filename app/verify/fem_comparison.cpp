// See app/verify/fem_comparison.h.
#include "app/verify/fem_comparison.h"

#include "app/verify/lattice_statics.h"

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

constexpr double kTetgenSeconds = 300;
constexpr double kPlaneTolerance = 1e-9;  // m
constexpr double kSolverTolerance = 1e-4; // of the finite elements: far below any difference that counts

} // namespace

glm::dvec3 LatticeField::at(const glm::dvec3& world) const {
    glm::dvec3 sum(0);
    double weights = 0;
    for (const TrilinearCorner& corner : trilinearCorners(*lattice, lattice->toLattice(world))) {
        if (corner.node < 0)
            continue;
        weights += corner.weight;
        sum += corner.weight * displacements[std::size_t(corner.node)];
    }
    return weights > 0 ? sum / weights : glm::dvec3(0);
}

Result<FemModel> makeFemModel(const PlaneCut& cut, const ElasticSolid& solid, double density,
                              double largestVolume) {
    FemModel model;
    SEROSA_ASSIGN(model.mesh, fillWithTets(cut, largestVolume, kTetgenSeconds));
    model.stiffness = femStiffness(model.mesh, solid);
    for (const glm::dvec3& node : model.mesh.nodes)
        model.held.push_back(node.y <= cut.height + kPlaneTolerance);
    model.density = density;
    return model;
}

Result<FemRest> femUnder(const FemModel& model, const glm::dvec3& acceleration) {
    const Eigen::VectorXd forces = bodyForces(model.mesh, model.density * acceleration);
    SEROSA_ASSIGN(Eigen::VectorXd displacements,
                  solveFem(model.mesh, model.stiffness, forces, model.held, {}, kSolverTolerance));
    return FemRest{acceleration, std::move(displacements)};
}

FemRest scaledToStrain(const FemModel& model, FemRest rest, double strain) {
    const double scale = strain / largestStrain(model.mesh, rest.displacements);
    rest.acceleration *= scale;
    rest.displacements *= scale;
    return rest;
}

std::vector<bool> nodesBelow(const sim::Lattice& lattice, double height) {
    std::vector<bool> below;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        below.push_back(lattice.toWorld(lattice.restPosition(node)).y <= height + kPlaneTolerance);
    return below;
}

LatticeField latticeStatics(const sim::SolverSetup& setup) {
    const sim::Lattice& lattice = *setup.lattice;
    const double h = lattice.spacing;
    // A full node's weight in k h.
    const glm::dvec3 weight =
        setup.gravity * (setup.tissue.nodeMass(h) / (setup.tissue.springConstant(h) * h));
    LatticeProblem problem(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        problem.push(node, lattice.massShare(node) * weight);
        if (setup.fixed[node])
            problem.hold(node);
    }
    const Eigen::VectorXd moved = problem.solve(setup.tissue);
    LatticeField field{&lattice, {}};
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        field.displacements.push_back(h * nodeVector(moved, node));
    return field;
}

SettledLattice
settleLattice(sim::SolverSetup setup, const LatticeField& statics,
              const std::function<std::unique_ptr<sim::Solver>(const sim::SolverSetup&)>& make) {
    const sim::Lattice& lattice = *setup.lattice;
    // Rayleigh's quotient: twice the elastic energy is what the weight does on its way to rest.
    double work = 0, inertia = 0, largest = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const glm::dvec3& u = statics.displacements[node];
        if (setup.fixed[node])
            continue;
        work += lattice.massShare(node) * glm::dot(setup.gravity, u);
        inertia += lattice.massShare(node) * glm::dot(u, u);
        largest = std::max(largest, glm::length(u));
    }
    const double rate = std::sqrt(work / inertia); // rad/s
    setup.tissue.airDrag = 2 * rate;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
    const std::unique_ptr<sim::Solver> solver = make(setup);
    solver->setState(sim::startState(setup));
    // What is left falls as (1 + x) exp(-x): 5e-4 at x = 10; faster motions swing it out as fast.
    SettledLattice settled;
    const int tenth = int(std::ceil(1.2 / rate / setup.timeStep));
    settled.steps = 10 * tenth;
    solver->advance(9 * tenth);
    const sim::LatticeState before = solver->state();
    solver->advance(tenth);
    const sim::LatticeState after = solver->state();
    settled.field.lattice = &lattice;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        settled.field.displacements.push_back(lattice.spacing *
                                              (after.positions[node] - lattice.restPosition(node)));
        settled.unrest = std::max(
            settled.unrest, lattice.spacing * glm::distance(after.positions[node], before.positions[node]));
    }
    settled.unrest /= largest;
    return settled;
}

FieldDifference compareFields(const FemModel& model, const FemRest& rest, const LatticeField& lattice) {
    double difference = 0, size = 0, volume = 0;
    FieldDifference result;
    for (std::size_t element = 0; element < model.mesh.elements.size(); ++element)
        for (const TetPoint& point : gaussPoints(model.mesh, element)) {
            glm::dvec3 place(0);
            for (std::size_t a = 0; a < 10; ++a)
                place += point.shapes[a] * model.mesh.nodes[model.mesh.elements[element][a]];
            const glm::dvec3 expected = displacementAt(model.mesh, element, point, rest.displacements);
            const double apart = glm::distance(lattice.at(place), expected);
            difference += point.volume * apart;
            size += point.volume * glm::length(expected);
            volume += point.volume;
            result.largest = std::max(result.largest, apart);
        }
    result.mean = difference / size;
    result.meanSize = size / volume;
    result.largest /= result.meanSize;
    return result;
}

} // namespace serosa::app
