// See app/verify/implicit_bodies.h.
#include "app/verify/implicit_bodies.h"

#include <algorithm>

namespace serosa::app {

namespace {

/// \param at of the cell's middle, -1 to 1 along each axis
bool insideBall(const glm::ivec3& cell, int across) {
    const glm::dvec3 at = (glm::dvec3(cell) + 0.5) * 2.0 / double(across) - 1.0;
    return glm::dot(at, at) < 1;
}

/// Cells of material 1 have a neighbour outside.
sim::Lattice capsuleLattice(int across) {
    std::vector<sim::LatticeCell> cells;
    for (int i = 0; i < across * across * across; ++i) {
        const glm::ivec3 cell(i % across, i / across % across, i / across / across);
        if (!insideBall(cell, across))
            continue;
        bool outer = false;
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {-1, 1}) {
                glm::ivec3 beside = cell;
                beside[axis] += side;
                outer = outer || !insideBall(beside, across);
            }
        cells.push_back({cell, 255, std::uint8_t(outer ? 1 : 0)});
    }
    return sim::latticeFromCells(std::move(cells), 0.06 / across, glm::dvec3(0));
}

} // namespace

ImplicitBody::ImplicitBody(sim::Lattice made, double young) : lattice(std::move(made)) {
    setup.lattice = &lattice;
    setup.tissue.young = young;
    setup.tissue.dampingTime = 0;
    setup.gravity = {0, -9.81, 0};
    setup.timeStep = kImplicitFrame;
    setup.method = sim::StepMethod::implicit;
}

void ImplicitBody::fixWhere(bool (*where)(const glm::ivec3& node)) {
    setup.fixed.clear();
    for (const glm::ivec3& node : lattice.nodes)
        setup.fixed.push_back(where(node));
}

sim::SolverSetup ImplicitBody::withExplicitSteps() const {
    sim::SolverSetup twin = setup;
    twin.method = sim::StepMethod::explicitSteps;
    twin.timeStep = sim::stableStep(lattice, twin.tissue, kImplicitFrame).timeStep;
    return twin;
}

sim::Lattice blockOfCells(const glm::ivec3& cells, double spacing) {
    std::vector<sim::LatticeCell> list;
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x)
                list.push_back({{x, y, z}, 255});
    return sim::latticeFromCells(std::move(list), spacing, glm::dvec3(0));
}

std::unique_ptr<ImplicitBody> capsuleBody(int across) {
    auto body = std::make_unique<ImplicitBody>(capsuleLattice(across), 1000);
    body->setup.tissue.dampingTime = 0.0005;
    sim::Material capsule = body->setup.tissue;
    capsule.name = "capsule";
    capsule.young = 1e6;
    body->setup.tissue.others = {capsule};
    body->fixWhere([](const glm::ivec3& node) { return node.y <= 2; });
    return body;
}

double largestDistance(const sim::LatticeState& a, const sim::LatticeState& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
        const double apart = glm::distance(a.positions[i], b.positions[i]);
        most = apart <= most ? most : apart; // what is no number stays
    }
    return most;
}

} // namespace serosa::app
