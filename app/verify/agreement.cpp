// Part of group `cuts`: the heart with a probe and a blade, 300 steps on every solver. All follow the
// reference, give the same bytes again, and go on from a snapshot to the same bytes as if they had never
// stopped.
#include "app/solver_choice.h"
#include "app/verify/cuts.h"
#include "models/phantom.h"
#include "sim/pieces.h"
#include "sim/snapshot.h"

#include <algorithm>

namespace serosa::app {

namespace {

constexpr int kSteps = 300, kSnapshotAt = 200;

/// Held at its lowest nodes, pressed from the side, cut from above.
struct CutHeart {
    sim::Lattice lattice;
    sim::SolverSetup setup;
    sim::Stroke stroke;

    CutHeart(sim::Lattice heart, const sim::Tissue& tissue) : lattice(std::move(heart)) {
        const double height = lattice.nodeDims.y;
        for (sim::LatticeCell& cell : lattice.cells)
            cell.material = tissue.others.empty() ? 0 : cell.grid.y > 0.5 * height ? 1 : 0;
        setup.lattice = &lattice;
        setup.tissue = tissue;
        setup.gravity = {0, -9.81, 0};
        setup.timeStep = sim::stableStep(lattice, tissue, 1.0 / 60).timeStep;
        for (const glm::ivec3& node : lattice.nodes)
            setup.fixed.push_back(node.y < 4);
        const glm::dvec3 low = lattice.toWorld(-glm::dvec3(lattice.centre)),
                         high = lattice.toWorld(glm::dvec3(lattice.nodeDims - 1 - lattice.centre)),
                         middle = 0.5 * (low + high), side{high.x + 0.004, middle.y, middle.z};
        setup.tools = {{"probe",
                        sim::ToolMode::push,
                        0.008,
                        {{0, side}, {kSteps * setup.timeStep, side - glm::dvec3(0.015, 0, 0)}}}};
        stroke.from = {glm::dvec3(middle.x + 0.003, high.y + 0.01, low.z), {middle.x, high.y + 0.01, high.z}};
        stroke.to = {glm::dvec3(middle.x + 0.001, middle.y, low.z), {middle.x - 0.002, middle.y, high.z}};
    }
    CutHeart(const CutHeart&) = delete;
    CutHeart& operator=(const CutHeart&) = delete;
};

/// To the end, by way of a snapshot where `resumed` is another solver.
Result<sim::LatticeState> play(const CutHeart& heart, sim::Solver& solver, sim::Solver* resumed = nullptr) {
    // At rest, where float32 is exact: every solver cuts the same springs. Later a spring at the very end of
    // the blade may be met by one and missed by another, whose motions then part.
    SEROSA_TRY(solver.cut(heart.stroke));
    solver.advance(kSnapshotAt);
    sim::Solver* last = &solver;
    if (resumed) {
        sim::OrganSnapshot snapshot;
        sim::takeSnapshot(solver, snapshot);
        SEROSA_TRY(sim::restoreSnapshot(snapshot, *resumed));
        last = resumed;
    }
    last->advance(kSteps - kSnapshotAt);
    return last->state();
}

} // namespace

Status verifyAgreement(const VerifyOptions& options, CheckList& checks) {
    sim::Tissue plain;
    plain.dampingTime =
        0.002; // else barely filled cells that hang by a spring after the cut swing chaotically
    sim::Tissue rich = plain;
    rich.poisson = 0.45;
    sim::Material stiff = rich;
    stiff.young = 8000;
    stiff.density = 1100;
    stiff.curve = {{0.05, 400}, {0.2, 4000}};
    rich.others = {stiff};
    for (const auto& [name, tissue] :
         {std::pair{"plain springs", plain}, {"two materials at nu 0.45", rich}}) {
        SEROSA_ASSIGN(sim::Lattice lattice,
                      models::phantomLattice("heart", 20000, options.full ? 20000 : 5000));
        CutHeart heart(std::move(lattice), tissue);
        const auto reference = sim::makeReferenceSolver(heart.setup);
        SEROSA_ASSIGN(const sim::LatticeState expected, play(heart, *reference));
        const std::string of = std::string("heart with probe and cut, ") + name + ": ";
        checks.atLeast(of + "springs cut", double(sim::springsCut(heart.lattice, expected.connections)), 100,
                       "");
        if (options.inject.fault == Fault::stiffness)
            heart.setup.tissue.young *= options.inject.factor;
        for (const std::string& solver : solverNames()) {
            if (solver == "reference" || (!options.solver.empty() && options.solver != solver))
                continue;
            std::unique_ptr<sim::Solver> solvers[4];
            for (auto& made : solvers) {
                SEROSA_ASSIGN(made, makeSolver(solver, heart.setup, -1));
            }
            SEROSA_ASSIGN(const sim::LatticeState got, play(heart, *solvers[0]));
            SEROSA_ASSIGN(const sim::LatticeState again, play(heart, *solvers[1]));
            SEROSA_ASSIGN(const sim::LatticeState resumed, play(heart, *solvers[2], solvers[3].get()));
            double worst = 0;
            for (std::size_t node = 0; node < got.positions.size(); ++node) {
                const double apart = glm::distance(got.positions[node], expected.positions[node]);
                worst = apart <= worst ? worst : apart; // what is no number stays
            }
            checks.equalAbs(of + solver + " cuts other springs than the reference",
                            got.connections == expected.connections ? 0 : 1, 0, 0, "");
            checks.atMost(of + solver + " against reference after 300 steps", worst, 1e-3, "h");
            checks.equalAbs(of + solver + ", same bytes on a second run", got.hash() == again.hash() ? 0 : 1,
                            0, 0, "");
            checks.equalAbs(of + solver + ", same bytes 100 steps after a restore",
                            got.hash() == resumed.hash() ? 0 : 1, 0, 0, "");
        }
    }
    return {};
}

} // namespace serosa::app
