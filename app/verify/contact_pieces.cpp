// See app/verify/contact_pieces.h.
#include "app/verify/contact_pieces.h"

#include "app/solver_choice.h"
#include "sim/tissue_field.h"

namespace serosa::app {

namespace {

sim::Lattice block(const glm::ivec3& cells, double spacing, const glm::dvec3& corner) {
    std::vector<sim::LatticeCell> list;
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x)
                list.push_back({{x, y, z}, 255});
    sim::Lattice lattice = sim::latticeFromCells(std::move(list), spacing, glm::dvec3(0));
    lattice.origin = corner - spacing * lattice.restPosition(0);
    return lattice;
}

} // namespace

ContactPiece::ContactPiece(const glm::ivec3& cells, double spacing, const glm::dvec3& corner,
                           const sim::Tissue& tissue)
    : ContactPiece(block(cells, spacing, corner), tissue) {}

ContactPiece::ContactPiece(sim::Lattice given, const sim::Tissue& tissue) : lattice(std::move(given)) {
    setup.lattice = &lattice;
    setup.tissue = tissue;
    setup.timeStep = sim::stableStep(lattice, tissue, 1.0 / 60).timeStep;
}

double ContactPiece::mass(std::size_t node) const {
    return setup.tissue.nodeMass(lattice.spacing) * lattice.massShare(node);
}

double ContactPiece::totalMass() const {
    double sum = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        sum += mass(node);
    return sum;
}

glm::dvec3 ContactPiece::centre(const sim::LatticeState& state) const {
    glm::dvec3 sum(0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        sum += mass(node) * lattice.toWorld(state.positions[node]);
    return sum / totalMass();
}

glm::dvec3 ContactPiece::momentum(const sim::LatticeState& state) const {
    glm::dvec3 sum(0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        sum += mass(node) * state.increments[node];
    return sum * (lattice.spacing / setup.timeStep);
}

glm::dvec3 ContactPiece::angularMomentum(const sim::LatticeState& state, const glm::dvec3& about) const {
    glm::dvec3 sum(0);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        sum +=
            mass(node) * glm::cross(lattice.toWorld(state.positions[node] - state.increments[node]) - about,
                                    state.increments[node]);
    return sum * (lattice.spacing / setup.timeStep);
}

sim::Body floorAt(double height, double friction) {
    sim::Body floor;
    floor.name = "floor";
    floor.shape.kind = sim::ShapeKind::halfSpace;
    floor.shape.radius = 0;
    floor.pose.at = {0, height, 0};
    floor.friction = friction;
    return floor;
}

std::vector<std::string> comparedSolvers(const VerifyOptions& options) {
    std::vector<std::string> names;
    for (const std::string& name : solverNames())
        if (name != "reference" && (options.solver.empty() || options.solver == name))
            names.push_back(name);
    return names;
}

} // namespace serosa::app
