// Group `solver`: the lattice and its solvers against closed forms, conservation and each other. The solvers
// run through the same measures; the fault that --inject names is put into the tissue or the lattice that
// they are given.
#include "app/solver_choice.h"
#include "app/verify/elastic_measures.h"
#include "app/verify/verify.h"
#include "models/phantom.h"
#include "shaders/shared_constants.h"
#include "sim/cpu_solver.h"

#include <cmath>
#include <random>

namespace serosa::app {

namespace {

using sim::Lattice;
using sim::LatticeState;
using sim::Solver;
using sim::SolverSetup;

enum class Which { reference, fragment, cpu };
const char* label(Which which) {
    return which == Which::reference ? "reference" : which == Which::fragment ? "fragment" : "cpu";
}

/// A body under test: the lattice with the injected fault, and the setup that points to it.
struct Body {
    Lattice lattice;
    SolverSetup setup;

    Body(Lattice shape, const Injection& inject) : lattice(std::move(shape)) {
        if (inject.fault == Fault::dropSpring)
            dropSpring();
        if (inject.fault == Fault::stiffness)
            setup.tissue.young *= inject.factor;
        setup.tissue.dampingTime = 0;
        setup.timeStep = sim::stableStep(lattice, setup.tissue, 1).timeStep;
        setup.lattice = &lattice;
    }
    Body(const Body&) = delete;
    Body& operator=(const Body&) = delete;

    Result<std::unique_ptr<Solver>> solver(Which which, int layout = -1) const {
        if (which == Which::reference)
            return sim::makeReferenceSolver(setup);
        if (which == Which::cpu)
            return sim::makeCpuSolver(setup);
        sim::FragmentOptions options;
        options.layout = layout;
        return sim::makeFragmentSolver(setup, options);
    }

private:
    void dropSpring() {
        const std::size_t node = lattice.nodeCount() / 2;
        for (int d = 0; d < SRS_NEIGHBOURS; ++d)
            if (const std::int64_t other = lattice.neighbour(node, d); other >= 0) {
                lattice.connections[node] &= ~(1u << d);
                lattice.connections[std::size_t(other)] &= ~(1u << (d ^ 1));
                return;
            }
    }
};

Lattice block(int nx, int ny, int nz, double spacing = 0.003) {
    std::vector<sim::LatticeCell> cells;
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x)
                cells.push_back({{x, y, z}, 255});
    return sim::latticeFromCells(cells, spacing, glm::dvec3(0));
}

double random01(std::mt19937& random) {
    return double(random()) / 4294967296.0;
}

glm::dvec3 randomVector(std::mt19937& random) {
    const double x = random01(random), y = random01(random), z = random01(random);
    return 2.0 * glm::dvec3(x, y, z) - 1.0;
}

/// One spring of a lone cell, stretched by 10%, against its closed-form step; all other springs are cut.
Status oneSpring(const VerifyOptions& options, Which which, CheckList& checks) {
    double worst = 0;
    for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
        Body body(block(1, 1, 1), options.inject.fault == Fault::dropSpring ? Injection{} : options.inject);
        std::size_t node = 0;
        while (body.lattice.neighbour(node, d) < 0)
            ++node;
        const std::size_t other = std::size_t(body.lattice.neighbour(node, d));
        std::fill(body.lattice.connections.begin(), body.lattice.connections.end(), 0u);
        body.lattice.connections[node] = 1u << d;
        body.lattice.connections[other] = 1u << (d ^ 1);
        const glm::dvec3 direction = glm::normalize(glm::dvec3(sim::kNeighbourOffsets[std::size_t(d)]));
        LatticeState state = sim::restState(body.lattice);
        const double rest = d < 6 ? 1 : std::sqrt(2.0), stretch = 0.1 * rest;
        state.positions[other] += stretch * direction;
        SEROSA_ASSIGN(const std::unique_ptr<Solver> solver, body.solver(which));
        solver->setState(state);
        solver->advance(1);
        const LatticeState after = solver->state();
        // The lone cell's share of the spring: k/4 on an edge, k/2 on a diagonal; of the mass: 1/8 a corner.
        const sim::Tissue nominal;
        const double dt = body.setup.timeStep;
        const double step =
            dt * dt * nominal.stiffnessOverMass(body.lattice.spacing) * (d < 6 ? 0.25 : 0.5) * 8 * stretch;
        worst = std::max(
            worst, glm::length(after.positions[node] - body.lattice.restPosition(node) - step * direction));
        worst = std::max(worst, glm::length(after.positions[other] - body.lattice.restPosition(other) -
                                            (stretch - step) * direction));
    }
    checks.equalAbs(std::string("one spring, one step, 18 directions, ") + label(which), worst, 0,
                    which == Which::reference ? 1e-12 : 1e-6, "h");
    return {};
}

/// Undamped free fall from where every run begins.
Status freeFall(const VerifyOptions& options, Which which, const Lattice& ball, CheckList& checks) {
    Body body(ball, options.inject);
    body.setup.gravity = {0, -9.81, 0};
    SEROSA_ASSIGN(const std::unique_ptr<Solver> solver, body.solver(which));
    const double dt = body.setup.timeStep, h = body.lattice.spacing;
    solver->setState(sim::startState(body.setup));
    const int steps = 400;
    solver->advance(steps);
    const LatticeState after = solver->state();
    glm::dvec3 moved(0);
    double mass = 0;
    for (std::size_t node = 0; node < after.positions.size(); ++node) {
        moved += body.lattice.massShare(node) * (after.positions[node] - body.lattice.restPosition(node));
        mass += body.lattice.massShare(node);
    }
    const double path = 0.5 * 9.81 * (steps * dt) * (steps * dt);
    checks.equalRel(std::string("free fall of the centre of mass, ") + label(which), -moved.y / mass * h,
                    path, 1e-5, "m");
    return {};
}

Status momentum(const VerifyOptions& options, Which which, const Lattice& ball, CheckList& checks) {
    Body body(ball, options.inject);
    std::mt19937 random(3);
    LatticeState state = sim::restState(body.lattice);
    for (glm::dvec3& u : state.increments)
        u = 0.01 * randomVector(random);
    SEROSA_ASSIGN(const std::unique_ptr<Solver> solver, body.solver(which));
    solver->setState(state);
    const auto sum = [&body](const LatticeState& s, bool absolute) {
        glm::dvec3 total(0);
        for (std::size_t node = 0; node < s.increments.size(); ++node)
            total += body.lattice.massShare(node) *
                     (absolute ? glm::dvec3(glm::length(s.increments[node])) : s.increments[node]);
        return total;
    };
    const LatticeState start = solver->state();
    solver->advance(1000);
    const LatticeState after = solver->state();
    checks.atMost(std::string("momentum drift over 1,000 steps / sum of m|v|, ") + label(which),
                  glm::length(sum(after, false) - sum(start, false)) / sum(start, true).x, 1e-5, "1");
    return {};
}

Status restStays(const VerifyOptions& options, const Lattice& shape, const std::string& name,
                 CheckList& checks) {
    Body body(shape, options.inject);
    SEROSA_ASSIGN(const std::unique_ptr<Solver> solver, body.solver(Which::fragment));
    solver->advance(10000);
    const LatticeState after = solver->state();
    double worst = 0;
    for (std::size_t node = 0; node < after.positions.size(); ++node)
        worst = std::max(worst, glm::length(after.positions[node] - body.lattice.restPosition(node)));
    checks.atMost("rest without load for 10,000 steps, " + name + ", fragment", worst, 1e-5, "h");
    return {};
}

Status rigidMotion(const VerifyOptions& options, Which which, const Lattice& shape, CheckList& checks) {
    Body body(shape, options.inject);
    double worst = 0;
    SEROSA_ASSIGN(const std::unique_ptr<Solver> solver, body.solver(which));
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        const glm::dmat3 turn = randomRotation(seed);
        std::mt19937 random(seed);
        const glm::dvec3 shift = randomVector(random);
        LatticeState state = sim::restState(body.lattice);
        for (glm::dvec3& x : state.positions)
            x = turn * x + shift;
        solver->setState(state);
        solver->advance(1);
        const LatticeState after = solver->state();
        const double unit = body.setup.timeStep * body.setup.timeStep *
                            body.setup.tissue.stiffnessOverMass(body.lattice.spacing);
        for (std::size_t node = 0; node < after.increments.size(); ++node)
            worst =
                std::max(worst, glm::length(after.increments[node]) * body.lattice.massShare(node) / unit);
    }
    checks.atMost(std::string("nodal force after a random rigid motion, ") + label(which), worst,
                  which == Which::reference ? 1e-12 : 1e-5, "k h");
    return {};
}

/// Energy of uniform strains against an isotropic solid with lambda = mu = k/h; `fill` of every cell in
/// 1/255.
Status strainEnergy(const VerifyOptions& options, const std::string& name, bool partial, CheckList& checks) {
    Lattice shape = block(4, 4, 4);
    if (partial) {
        std::vector<sim::LatticeCell> cells = shape.cells;
        std::mt19937 random(11);
        for (sim::LatticeCell& cell : cells)
            cell.fill = std::uint8_t(1 + random() % 255);
        shape = sim::latticeFromCells(cells, shape.spacing, glm::dvec3(0));
    }
    Body body(std::move(shape), options.inject);
    const double h = body.lattice.spacing, mu = sim::Tissue().springConstant(h) / h, lambda = mu;
    double volume = 0;
    for (const sim::LatticeCell& cell : body.lattice.cells)
        volume += cell.fill / 255.0 * h * h * h;
    double worst = 0;
    for (int mode = 0; mode < 8; ++mode) {
        glm::dmat3 strain(0);
        if (mode < 3)
            strain[mode][mode] = 1e-4;
        else if (mode < 6)
            strain[mode % 3][(mode + 1) % 3] = strain[(mode + 1) % 3][mode % 3] = 1e-4;
        else // two general ones
            strain = mode == 6 ? glm::dmat3(1e-4)
                               : glm::dmat3({1e-4, 4e-5, -3e-5}, {4e-5, -6e-5, 2e-5}, {-3e-5, 2e-5, 5e-5});
        LatticeState state = sim::restState(body.lattice);
        for (glm::dvec3& x : state.positions)
            x += strain * x;
        double square = 0;
        for (int i = 0; i < 3; ++i)
            square += glm::dot(strain[i], strain[i]);
        const double trace = strain[0][0] + strain[1][1] + strain[2][2];
        const double expected = volume * (0.5 * lambda * trace * trace + mu * square);
        worst = std::max(worst, std::abs(sim::energies(body.setup, state).elastic / expected - 1));
    }
    checks.equalAbs("energy density at strain 1e-4, lambda = mu = k/h, " + name, worst, 0, 1e-3, "1");
    return {};
}

Status beams(const VerifyOptions& options, CheckList& checks) {
    for (std::uint32_t turn = 0; turn < 4; ++turn) {
        const std::string name = turn == 0 ? "aligned" : "turn " + std::to_string(turn);
        Beam beam = makeBeam(10, 40, turn == 0 ? glm::dmat3(1) : randomRotation(turn), 0.003);
        const BeamMeasures measures = measureBeam(beam);
        checks.equalRel("beam 10 x 10 x 40, " + name + ": E / (2.5 k/h)", measures.youngShare, 1, 0.02, "1");
        checks.equalRel("beam 10 x 10 x 40, " + name + ": Poisson's ratio", measures.poisson, 0.25, 0.02,
                        "1");
        checks.equalRel("beam 10 x 10 x 40, " + name + ": bending stiffness / E I", measures.bendingShare, 1,
                        0.05, "1");
        if (turn > 1)
            continue;
        Body body(beam.lattice, options.inject);
        checks.atMost("beam, " + name + ": reference force against the linear stiffness",
                      linearForceMismatch(body.setup), 1e-5, "1");
        const double closedForm =
            2 * beam.length * 0.003 / std::sqrt(sim::Tissue().young / sim::Tissue().density);
        for (const Which which : {Which::reference, Which::fragment, Which::cpu}) {
            SEROSA_ASSIGN(const std::unique_ptr<Solver> solver, body.solver(which));
            checks.equalRel("beam, " + name + ": first longitudinal period, " + label(which),
                            longitudinalPeriod(beam, body.setup, *solver), closedForm, 0.02, "s");
        }
    }
    return {};
}

/// A solver as the heart comparison takes it: those that step in textures on both layouts.
struct Compared {
    std::string label, solver;
    int layout;
};
std::vector<Compared> comparedSolvers(const VerifyOptions& options) {
    std::vector<Compared> list;
    for (const std::string& name : solverNames()) {
        if (name == "reference" || (!options.solver.empty() && options.solver != name))
            continue;
        if (name != "fragment" && name != "compute") {
            list.push_back({name, name, -1});
            continue;
        }
        list.push_back({name + " (rows)", name, SRS_LAYOUT_ROWS});
        list.push_back({name + " (grid)", name, SRS_LAYOUT_GRID});
    }
    return list;
}

/// Soft tissue pressed by a moving probe and hung on its lowest nodes, 100 steps, with every solver.
Status heartAgainstReference(const VerifyOptions& options, const Lattice& heart, CheckList& checks) {
    Body body(heart, {}), faulty(heart, options.inject);
    const glm::dvec3 low = body.lattice.toWorld(-glm::dvec3(body.lattice.centre));
    const glm::dvec3 high = body.lattice.toWorld(glm::dvec3(body.lattice.nodeDims - 1 - body.lattice.centre));
    for (Body* b : {&body, &faulty}) {
        b->setup.gravity = {0, -9.81, 0};
        b->setup.tissue.dampingTime = 0.0004;
        b->setup.timeStep = sim::stableStep(body.lattice, body.setup.tissue, 1.0 / 60).timeStep;
        const double end = 100 * b->setup.timeStep;
        const glm::dvec3 side{high.x + 0.004, 0.5 * (low.y + high.y), 0.5 * (low.z + high.z)};
        b->setup.tools = {
            {"probe", sim::ToolMode::push, 0.008, {{0, side}, {end, side - glm::dvec3(0.015, 0, 0)}}}};
        for (const glm::ivec3& node : b->lattice.nodes)
            b->setup.fixed.push_back(node.y < 4);
    }
    const std::unique_ptr<Solver> reference = sim::makeReferenceSolver(body.setup);
    reference->advance(100);
    const LatticeState expected = reference->state();
    const glm::dvec3 impulse = reference->takeToolImpulses()[0];
    double moved = 0;
    for (std::size_t node = 0; node < expected.positions.size(); ++node)
        moved = std::max(moved, glm::length(expected.positions[node] - body.lattice.restPosition(node)));
    checks.atLeast("heart, 100 steps with a probe: largest movement", moved, 0.5, "h");
    for (const Compared& compared : comparedSolvers(options)) {
        std::string hashes[2];
        for (std::string& hash : hashes) {
            SEROSA_ASSIGN(const std::unique_ptr<Solver> solver,
                          makeSolver(compared.solver, faulty.setup, compared.layout));
            solver->advance(100);
            const LatticeState got = solver->state();
            hash = got.hash();
            if (&hash != &hashes[0])
                continue;
            double worst = 0;
            for (std::size_t node = 0; node < got.positions.size(); ++node)
                worst = std::max(worst, glm::length(got.positions[node] - expected.positions[node]));
            checks.atMost("heart, 100 steps with a probe: " + compared.label + " against reference", worst,
                          1e-3, "h");
            const glm::dvec3 gotImpulse = solver->takeToolImpulses()[0];
            checks.equalAbs("heart: probe's impulse, " + compared.label + " over reference",
                            glm::length(gotImpulse - impulse) / glm::length(impulse), 0, 1e-3, "1");
        }
        checks.equalAbs("heart: same bytes on a second run, " + compared.label,
                        hashes[0] == hashes[1] ? 0 : 1, 0, 0, "1");
    }
    return {};
}

/// 4 x 4 x 40 nodes hung by the top at 0.1 ms steps for 1.2 s: slow sag is where float32 loses increments.
Status hangingColumn(const VerifyOptions& options, CheckList& checks) {
    Body body(block(3, 39, 3), {}), faulty(block(3, 39, 3), options.inject);
    for (Body* b : {&body, &faulty}) {
        b->setup.gravity = {0, -9.81, 0};
        b->setup.tissue.dampingTime = 0.0004;
        b->setup.timeStep = 1e-4;
        for (const glm::ivec3& node : b->lattice.nodes)
            b->setup.fixed.push_back(node.y == 39);
    }
    const std::unique_ptr<Solver> reference = sim::makeReferenceSolver(body.setup);
    SEROSA_ASSIGN(const std::unique_ptr<Solver> fragment, faulty.solver(Which::fragment));
    double worst = 0;
    for (int tenth = 0; tenth < 12; ++tenth) {
        reference->advance(1000);
        fragment->advance(1000);
        const LatticeState expected = reference->state(), got = fragment->state();
        double difference = 0, movement = 0;
        for (std::size_t node = 0; node < got.positions.size(); ++node) {
            difference = std::max(difference, glm::length(got.positions[node] - expected.positions[node]));
            movement =
                std::max(movement, glm::length(expected.positions[node] - body.lattice.restPosition(node)));
        }
        worst = std::max(worst, difference / movement);
    }
    checks.atMost("hanging column 4 x 4 x 40, 1.2 s at 0.1 ms, every 0.1 s: fragment against reference",
                  worst, 1e-3, "of the movement");
    return {};
}

} // namespace

Status verifySolver(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(const Lattice ball, models::phantomLattice("ball", 5000, 3000));
    for (const Which which : {Which::reference, Which::fragment, Which::cpu}) {
        SEROSA_TRY(oneSpring(options, which, checks));
        SEROSA_TRY(freeFall(options, which, ball, checks));
        SEROSA_TRY(momentum(options, which, ball, checks));
        SEROSA_TRY(rigidMotion(options, which, ball, checks));
    }
    SEROSA_TRY(restStays(options, ball, "ball of 3,000 nodes", checks));
    SEROSA_TRY(strainEnergy(options, "full cells", false, checks));
    SEROSA_TRY(strainEnergy(options, "partly filled cells", true, checks));
    SEROSA_TRY(beams(options, checks));
    SEROSA_TRY(hangingColumn(options, checks));
    SEROSA_ASSIGN(const Lattice heart, models::phantomLattice("heart", 50000, 20000));
    SEROSA_TRY(heartAgainstReference(options, heart, checks));
    if (options.full)
        SEROSA_TRY(restStays(options, heart, "heart of 20,000 nodes", checks));
    return {};
}

} // namespace serosa::app
