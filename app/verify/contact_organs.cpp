// The part of the group `contact` about organs that touch each other, and one that folds onto itself
// (sim/organ_group.h). Two columns of different spacing, one on the other, are held by grasps at their far
// ends, pressed together: what one gives to the other, the other gives back; each grasp holds what the
// other organ gives; and the force is that of one column. The limbs of a fork fly at each other and do not
// pass.
#include "app/solver_choice.h"
#include "app/verify/contact_pieces.h"
#include "app/verify/elastic_measures.h"
#include "sim/organ_group.h"

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

constexpr double kCoarse = 0.003, kFine = 0.00225; // m
constexpr double kSide = 0.018, kPress = 0.0018;   // m: of a column, whose height it is, too

sim::Tissue columnTissue(const VerifyOptions& options) {
    sim::Tissue tissue;
    tissue.airDrag = 150; // at rest after 0.4 s
    if (options.inject.fault == Fault::stiffness)
        tissue.young *= options.inject.factor;
    return tissue;
}

/// Holds the nodes of a layer at this height.
sim::Tool holder(double height) {
    sim::Tool tool;
    tool.name = "holder";
    tool.mode = sim::ToolMode::grasp;
    tool.radius = 1e-4;
    tool.shape.kind = sim::ShapeKind::box;
    tool.shape.radius = tool.radius;
    tool.shape.halfSize = {kSide, kSide, 2e-4};
    const glm::dvec3 at(0, 0, height);
    tool.keys = {{0, at}, {10, at}};
    return tool;
}

/// Squeezed evenly by kPress over both heights: faces that met still do.
sim::LatticeState squeezed(const ContactPiece& piece) {
    sim::LatticeState state = sim::restState(piece.lattice);
    for (glm::dvec3& position : state.positions) {
        glm::dvec3 at = piece.lattice.toWorld(position);
        at.z *= 1 - kPress / (2 * kSide);
        position = piece.lattice.toLattice(at);
    }
    return state;
}

/// A square column along z whose surface is known: one of cells alone has rounded edges for contact.
std::unique_ptr<ContactPiece> column(double spacing, double bottom, int heights, const sim::Tissue& tissue) {
    const double cells = kSide / spacing;
    Beam beam = makeBeam(cells, heights * cells, glm::dmat3(1), spacing);
    beam.lattice.origin.z += bottom + 0.5 * heights * kSide;
    return std::make_unique<ContactPiece>(std::move(beam.lattice), tissue);
}

/// N along z, over the last 0.05 s of 0.45 s.
struct Pressed {
    glm::dvec3 onLow{0}, onHigh{0}; // from the other column
    double held[2] = {0, 0};        // by the grasp of the low and of the high one
};

Result<Pressed> pressColumns(const std::string& name, const sim::Tissue& tissue) {
    const auto low = column(kCoarse, 0, 1, tissue), high = column(kFine, kSide, 1, tissue);
    low->setup.tools = {holder(0)};
    high->setup.tools = {holder(2 * kSide - kPress)};
    const double step = std::min(low->setup.timeStep, high->setup.timeStep);
    low->setup.timeStep = high->setup.timeStep = step;
    SEROSA_ASSIGN(const auto first, makeSolver(name, low->setup));
    SEROSA_ASSIGN(const auto second, makeSolver(name, high->setup));
    first->setState(squeezed(*low));
    second->setState(squeezed(*high));
    SEROSA_ASSIGN(const auto group,
                  sim::OrganGroup::create({{first.get(), true, false}, {second.get(), true, false}}, {}));
    group->advance(int(0.4 / step));
    group->takeLoads();
    first->takeLoads();
    second->takeLoads();
    const int steps = int(0.05 / step);
    group->advance(steps);
    const sim::PairLoads loads = group->takeLoads();
    const double time = steps * step;
    return Pressed{loads[0][1].impulse / time,
                   loads[1][0].impulse / time,
                   {first->takeLoads()[0].impulse.z / time, second->takeLoads()[0].impulse.z / time}};
}

/// What a grasp holds of one column of both heights, pressed as far, by the reference, N.
double wholeColumn(const sim::Tissue& tissue) {
    const auto whole = column(kCoarse, 0, 2, tissue);
    whole->setup.tools = {holder(0), holder(2 * kSide - kPress)};
    const auto solver = sim::makeReferenceSolver(whole->setup);
    solver->setState(squeezed(*whole));
    solver->advance(int(0.4 / whole->setup.timeStep));
    solver->takeLoads();
    const int steps = int(0.05 / whole->setup.timeStep);
    solver->advance(steps);
    return solver->takeLoads()[0].impulse.z / (steps * whole->setup.timeStep);
}

Status pressedColumns(const VerifyOptions& options, const std::vector<std::string>& names,
                      CheckList& checks) {
    const double expected = wholeColumn(columnTissue({}));
    for (const std::string& name : names) {
        SEROSA_ASSIGN(const Pressed got, pressColumns(name, columnTissue(options)));
        const std::string of = "columns of 3 and 2.25 mm pressed together, " + name + ": ";
        // Each impulse on a node is taken from a triangle: nothing but the rounding of the sums is left (in
        // double; on the GPU they are integers).
        checks.atMost(of + "sum of both forces over one",
                      glm::length(got.onLow + got.onHigh) / glm::length(got.onLow), 1e-12, "1");
        // At rest; drag has e^-60 left of what moved, float32 a few 1e-4 of the force.
        checks.equalRel(of + "the low one's grasp holds", got.held[0], -got.onLow.z, 0.005, "N");
        checks.equalRel(of + "the high one's grasp holds", got.held[1], -got.onHigh.z, 0.005, "N");
        // Skins may lie a hundredth of a spacing into each other before they are pushed out: 0.03 mm of 1.8.
        checks.equalRel(of + "force, of one column of both heights", got.onHigh.z, expected, 0.02, "N");
    }
    return {};
}

/// Two limbs of 2 x 12 x 3 cells, 4 cells apart, on a base.
sim::Lattice fork() {
    std::vector<sim::LatticeCell> cells;
    for (int z = 0; z < 3; ++z)
        for (int x = 0; x < 8; ++x)
            for (int y = 0; y < 12; ++y)
                if (y < 2 || x < 2 || x >= 6)
                    cells.push_back({{x, y, z}, 255});
    return sim::latticeFromCells(std::move(cells), kCoarse, glm::dvec3(0));
}

/// How near the inner faces came, spacings (below 0: passed), and the energy gained, over that at the start.
struct Clap {
    double nearest = 4, gained = 0;
};

Result<Clap> clapFork(const std::string& name, bool contact) {
    ContactPiece piece(fork(), sim::Tissue());
    const sim::Lattice& lattice = piece.lattice;
    for (const glm::ivec3& node : lattice.nodes)
        piece.setup.fixed.push_back(node.y == 0);
    SEROSA_ASSIGN(const auto solver, makeSolver(name, piece.setup));
    sim::LatticeState state = sim::restState(lattice);
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        if (const glm::ivec3 at = lattice.nodes[node]; at.y > 2) // 0.9 m/s at the tips
            state.increments[node].x =
                (at.x <= 2 ? 0.09 : -0.09) * (at.y - 2) * piece.setup.timeStep / lattice.spacing;
    solver->setState(state);
    SEROSA_ASSIGN(const auto group, sim::OrganGroup::create({{solver.get(), false, contact}}, {}));
    const auto energy = [&] {
        const sim::Energies now = sim::energies(piece.setup, solver->state());
        return now.kinetic + now.elastic;
    };
    const double before = energy();
    Clap clap;
    for (int i = 0; i < 40; ++i) {
        group->advance(std::max(1, int(0.0015 / piece.setup.timeStep)));
        const sim::LatticeState now = solver->state();
        for (int y = 3; y < 12; ++y)
            for (int z = 1; z < 3; ++z)
                clap.nearest =
                    std::min(clap.nearest, now.positions[std::size_t(lattice.nodeAt({6, y, z}))].x -
                                               now.positions[std::size_t(lattice.nodeAt({2, y, z}))].x);
        clap.gained = std::max(clap.gained, energy() / before - 1);
    }
    return clap;
}

Status folds(const std::vector<std::string>& names, CheckList& checks) {
    SEROSA_ASSIGN(const Clap without, clapFork("reference", false));
    checks.atMost("limbs of a fork, without contact: they pass, by", without.nearest, -1, "spacings");
    for (const std::string& name : names) {
        SEROSA_ASSIGN(const Clap clap, clapFork(name, true));
        const std::string of = "limbs of a fork fly at each other, " + name + ": ";
        checks.atLeast(of + "nearest", clap.nearest, -0.15, "spacings");
        checks.atMost(of + "nearest (they meet)", clap.nearest, 0.2, "spacings");
        checks.atMost(of + "energy gained", clap.gained, 1e-3, "1");
    }
    return {};
}

} // namespace

Status verifyOrganContact(const VerifyOptions& options, CheckList& checks) {
    std::vector<std::string> names = comparedSolvers(options);
    names.push_back("reference");
    SEROSA_TRY(pressedColumns(options, names, checks));
    return folds(names, checks);
}

} // namespace serosa::app
