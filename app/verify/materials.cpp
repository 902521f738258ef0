// Group `materials`: what tissue of a given Young's modulus and Poisson's ratio does against the theory of
// elasticity. Statics by a linear solution in double with the same springs and cells (tied to the reference
// solver by its forces); large strains and float32 by the solvers themselves.
#include "app/verify/elastic_measures.h"
#include "app/verify/material_checks.h"
#include "models/phantom.h"
#include "shaders/shared_constants.h"
#include "sim/cpu_solver.h"

#include <cmath>
#include <random>

namespace serosa::app {

namespace {

using sim::Lattice;
using sim::LatticeState;
using sim::SolverSetup;

constexpr double kSpacing = 0.003; // m

/// Tension, shear, bending, torsion and pressure of beams and blocks 10 cells thick, aligned and in three
/// random turns.
void beams(const VerifyOptions& options, CheckList& checks) {
    for (std::uint32_t turn = 0; turn < 4; ++turn) {
        const std::string name = turn == 0 ? "aligned" : "turn " + std::to_string(turn);
        const glm::dmat3 rotation = turn == 0 ? glm::dmat3(1) : randomRotation(turn);
        const Beam beam = makeBeam(10, options.full ? 40 : 30, rotation, kSpacing);
        const Beam cube = makeBeam(10, 10, rotation, kSpacing);
        for (const double poisson : {0.25, 0.35, 0.45, 0.49}) {
            if (!options.full &&
                ((turn == 0 && poisson > 0.3 && poisson < 0.48) || (turn > 1 && poisson != 0.45)))
                continue;
            const std::string piece = "beam, " + name + ", " + nameOf(poisson);
            const sim::Tissue tissue = tissueOf(options, poisson);
            const BeamMeasures measures = measureBeam(beam, tissue, true);
            const double shear = shearShare(beam, tissue); // of k/h
            checks.equalRel(piece + ": Young's modulus / given", measures.youngShare, 1, 0.03, "1");
            checks.equalRel(piece + ": Poisson's ratio", measures.poisson, poisson, 0.03, "1");
            for (const auto& [young, density] : {std::pair(5000.0, 1000.0), std::pair(20000.0, 1060.0)})
                checks.equalRel(piece + ", E " + shortNumber(1e-3 * young) + " kPa: shear modulus",
                                shear * tissueOf(options, poisson, young, density).springConstant(kSpacing) /
                                    kSpacing,
                                young / (2 * (1 + poisson)), 0.03, "Pa");
            checks.equalRel(piece + ": bending stiffness / E I", measures.bendingShare, 1, 0.05, "1");
            // The section's shape, as 10 cells resolve it, enters with the fourth power.
            checks.equalRel(piece + ": torsional stiffness / (mu J)", measures.torsionShare, 1, 0.08, "1");
            checks.equalRel("block under pressure, " + name + ", " + nameOf(poisson) +
                                ": bulk modulus / E / (3 (1 - 2 nu))",
                            bulkModulusShare(cube, tissue), 1, 0.05, "1");
        }
    }
}

/// The figures above are statics of assumed forces: those of the reference solver, for two tissues.
void forces(const VerifyOptions& options, CheckList& checks) {
    const Beam beam = makeBeam(5, 8, randomRotation(1), kSpacing);
    for (const double poisson : {0.35, 0.49}) {
        SolverSetup setup;
        setup.lattice = &beam.lattice;
        setup.tissue = tissueOf(options, poisson);
        setup.tissue.dampingTime = 0;
        setup.timeStep = sim::stableStep(beam.lattice, setup.tissue, 1).timeStep;
        checks.atMost("beam, " + nameOf(poisson) + ": reference force against the linear stiffness",
                      linearForceMismatch(setup), 1e-4, "1");
    }
}

void cantilevers(const VerifyOptions& options, CheckList& checks) {
    for (const double poisson : {0.25, 0.35, 0.45, 0.49}) {
        if (!options.full && poisson == 0.35)
            continue;
        std::vector<double> errors;
        for (const int cells : {4, 6, 10}) {
            if (cells == 10 && !options.full && poisson != 0.45)
                continue;
            const Beam beam = makeBeam(cells, 6 * cells, glm::dmat3(1), kSpacing);
            const double share = cantileverSagShare(beam, tissueOf(options, poisson));
            errors.push_back(std::abs(share - 1));
            if (cells > 4)
                checks.equalRel("cantilever " + std::to_string(cells) + " cells thick, " + nameOf(poisson) +
                                    ": sag / beam theory",
                                share, 1, 0.05, "1");
        }
        const double ratio = errors.size() == 3 ? 10.0 / 4 : 6.0 / 4; // of the finest to the coarsest
        checks.atLeast("cantilever, " + nameOf(poisson) + ": order in h that the sag converges with",
                       std::log(errors.front() / errors.back()) / std::log(ratio), 1.5, "1");
    }
}

/// The heart pressed by a probe: the fragment solver on both texture layouts, and the CPU solver.
Status solversAgainstReference(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(const Lattice heart, models::phantomLattice("heart", 20000, options.full ? 20000 : 6000));
    SolverSetup setup;
    setup.lattice = &heart;
    setup.tissue = tissueOf({}, 0.45);
    setup.tissue.recovery = true;
    setup.gravity = {0, -9.81, 0};
    setup.timeStep = sim::stableStep(heart, setup.tissue, 1.0 / 60).timeStep;
    const double end = 100 * setup.timeStep;
    const glm::dvec3 low = heart.toWorld(-glm::dvec3(heart.centre));
    const glm::dvec3 high = heart.toWorld(glm::dvec3(heart.nodeDims - 1 - heart.centre));
    const glm::dvec3 side{high.x + 0.004, 0.5 * (low.y + high.y), 0.5 * (low.z + high.z)};
    setup.tools = {{"probe", sim::ToolMode::push, 0.008, {{0, side}, {end, side - glm::dvec3(0.015, 0, 0)}}}};
    for (const glm::ivec3& node : heart.nodes)
        setup.fixed.push_back(node.y < 4);
    const std::unique_ptr<sim::Solver> reference = sim::makeReferenceSolver(setup);
    reference->advance(100);
    const LatticeState expected = reference->state();
    if (options.inject.fault == Fault::stiffness)
        setup.tissue.young *= options.inject.factor;
    for (const std::string name : {"fragment (rows)", "fragment (grid)", "cpu"}) {
        std::string hashes[2];
        double worst = 0;
        for (std::string& hash : hashes) {
            std::unique_ptr<sim::Solver> solver;
            if (name == "cpu") {
                solver = sim::makeCpuSolver(setup);
            } else {
                sim::FragmentOptions fragment;
                fragment.layout = name == "fragment (rows)" ? SRS_LAYOUT_ROWS : SRS_LAYOUT_GRID;
                SEROSA_ASSIGN(solver, sim::makeFragmentSolver(setup, fragment));
            }
            solver->advance(100);
            const LatticeState got = solver->state();
            hash = got.hash();
            for (std::size_t node = 0; node < got.positions.size(); ++node) {
                const double apart = glm::length(got.positions[node] - expected.positions[node]);
                worst = std::isfinite(apart) ? std::max(worst, apart) : HUGE_VAL;
            }
        }
        checks.atMost("heart at nu 0.45, 100 steps with a probe: " + name + " against reference", worst, 1e-3,
                      "h");
        checks.equalAbs("heart at nu 0.45: same bytes on a second run (" + name + ")",
                        hashes[0] == hashes[1] ? 0 : 1, 0, 0, "1");
    }
    return {};
}

Status momentum(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(const Lattice ball, models::phantomLattice("ball", 5000, 3000));
    SolverSetup setup;
    setup.lattice = &ball;
    setup.tissue = tissueOf(options, 0.49);
    setup.tissue.recovery = true;
    setup.timeStep = sim::stableStep(ball, setup.tissue, 1).timeStep;
    LatticeState state = sim::restState(ball);
    std::mt19937 random(3);
    for (glm::dvec3& u : state.increments)
        for (int axis = 0; axis < 3; ++axis)
            u[axis] = 0.005 * (double(random()) / 2147483648.0 - 1);
    glm::dvec3 before(0);
    double size = 0;
    for (std::size_t node = 0; node < ball.nodeCount(); ++node) {
        before += ball.massShare(node) * state.increments[node];
        size += ball.massShare(node) * glm::length(state.increments[node]);
    }
    SEROSA_ASSIGN(const std::unique_ptr<sim::Solver> fragment, sim::makeFragmentSolver(setup));
    const std::unique_ptr<sim::Solver> cpu = sim::makeCpuSolver(setup);
    for (sim::Solver* solver : {fragment.get(), cpu.get()}) {
        solver->setState(state);
        solver->advance(1000);
        const LatticeState after = solver->state();
        glm::dvec3 drift = -before;
        for (std::size_t node = 0; node < ball.nodeCount(); ++node)
            drift += ball.massShare(node) * after.increments[node];
        checks.atMost(std::string("ball at nu 0.49: momentum drift over 1,000 steps / sum of m|v|, ") +
                          solver->name(),
                      glm::length(drift) / size, 1e-5, "1");
    }
    return {};
}

} // namespace

Status verifyMaterials(const VerifyOptions& options, CheckList& checks) {
    beams(options, checks);
    forces(options, checks);
    cantilevers(options, checks);
    SEROSA_TRY(verifyComposites(options, checks));
    SEROSA_TRY(verifyToolForces(options, checks));
    SEROSA_TRY(verifySqueeze(options, checks));
    SEROSA_TRY(momentum(options, checks));
    return solversAgainstReference(options, checks);
}

} // namespace serosa::app
