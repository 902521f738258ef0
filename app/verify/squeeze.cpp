// Group `materials`: what is squeezed between two large spheres at Poisson's ratio 0.49 keeps its volume, by
// the sum over its cells and by what the mapped surface encloses.
#include "app/verify/material_checks.h"
#include "models/phantom.h"
#include "render/surface_binding.h"
#include "sim/cell_volumes.h"
#include "sim/solver.h"

#include <string>

namespace serosa::app {

namespace {

struct Squeezed {
    double height = 0;  // of the surface along y, over its rest height
    double cells = 0;   // volume of the cells by their fills, over rest
    double surface = 0; // volume that the mapped surface encloses, over rest
};

/// Two spheres of thirty times the phantom's height press it along y to `share` of its height, and hold.
Result<Squeezed> squeeze(const std::string& phantom, std::size_t faces, std::size_t nodes, double share,
                         const sim::Tissue& tissue) {
    SEROSA_ASSIGN(const sim::TriangleMesh mesh, models::phantomInMetres(phantom, faces));
    sim::LatticeRequest request;
    request.nodes = nodes;
    SEROSA_ASSIGN(const sim::Lattice lattice, sim::buildLattice(mesh, request));
    const glm::dvec3 middle = 0.5 * (mesh.lowest() + mesh.highest());
    const double half = 0.5 * (mesh.highest() - mesh.lowest()).y, radius = 60 * half;
    sim::SolverSetup setup;
    setup.lattice = &lattice;
    setup.tissue = tissue;
    setup.tissue.dampingTime = 0.002;
    setup.tissue.airDrag = 20;
    setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
    for (const double side : {-1.0, 1.0}) {
        const glm::dvec3 start = middle + glm::dvec3(0, side * (radius + half), 0);
        setup.tools.push_back({"plate",
                               sim::ToolMode::push,
                               radius,
                               {{0, start}, {0.3, start - glm::dvec3(0, side * half * (1 - share), 0)}}});
    }
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> solver, sim::makeFragmentSolver(setup));
    solver->advance(int(0.5 / setup.timeStep));
    const sim::LatticeState state = solver->state();

    Squeezed result;
    const std::vector<double> ratios = sim::cellVolumeRatios(lattice, state);
    double fills = 0;
    for (std::size_t cell = 0; cell < ratios.size(); ++cell) {
        result.cells += lattice.cells[cell].fill * ratios[cell];
        fills += lattice.cells[cell].fill;
    }
    result.cells /= fills;
    sim::TriangleMesh moved = mesh;
    moved.positions = render::mapSurface(render::bindSurface(lattice, mesh, sim::Mapping::curvature),
                                         state.positions, state.normals);
    for (glm::dvec3& position : moved.positions)
        position = lattice.toWorld(position);
    result.surface = moved.volume() / mesh.volume();
    result.height = (moved.highest() - moved.lowest()).y / (2 * half);
    return result;
}

} // namespace

Status verifySqueeze(const VerifyOptions& options, CheckList& checks) {
    struct Case {
        const char* phantom;
        std::size_t faces, nodes;
        double share; // the liver's thin edge and vessels stand beyond the nodes that the plates hold
    };
    for (const Case& one :
         {Case{"ball", 5000, 2000, 0.8}, {"kidney", 20000, 8000, 0.8}, {"liver", 20000, 8000, 0.75}}) {
        if (!options.full && one.phantom != std::string("ball"))
            continue;
        SEROSA_ASSIGN(const Squeezed squeezed,
                      squeeze(one.phantom, one.faces, one.nodes, one.share, tissueOf(options, 0.49)));
        const std::string name = std::string(one.phantom) + " squeezed at nu 0.49: ";
        checks.atMost(name + "height / rest", squeezed.height, 0.85, "1");
        checks.equalAbs(name + "volume change, sum over cells", squeezed.cells - 1, 0, 0.02, "1");
        checks.equalAbs(name + "volume change, enclosed by the surface", squeezed.surface - 1, 0, 0.02, "1");
    }
    return {};
}

} // namespace serosa::app
