// Group `implicit`: one implicit step a frame of 1/60 s (sim/implicit_system.h). A capsule of 1 MPa around
// tissue of 1 kPa does not run away and comes to rest; what hangs, hangs as explicit steps have it; a
// pendulum swings on; float32 on all cores and on the GPU follows the reference.
// app/verify/implicit_scenarios.cpp has random organs.
#include "app/organ_setup.h"
#include "app/solver_choice.h"
#include "app/verify/contact_pieces.h"
#include "app/verify/implicit_bodies.h"
#include "app/verify/verify.h"

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

/// The setup that the checked solvers get: `--inject stiffness` makes them stiffer than what they are
/// compared with.
sim::SolverSetup checkedSetup(const VerifyOptions& options, sim::SolverSetup setup) {
    if (options.inject.fault == Fault::stiffness) {
        setup.tissue.young *= options.inject.factor;
        for (sim::Material& material : setup.tissue.others)
            material.young *= options.inject.factor;
    }
    return setup;
}

/// Where runs are long the processor will do, but with --full: that the passes of the GPU take the same steps
/// is what `agreement`, the capsule and tests of sim/ look at.
std::vector<std::string> longSolvers(const VerifyOptions& options) {
    if (options.full || !options.solver.empty())
        return comparedSolvers(options);
    return {"cpu"};
}

sim::LatticeState settled(const sim::SolverSetup& setup, int steps) {
    const auto solver = sim::makeReferenceSolver(setup);
    solver->setState(sim::startState(setup));
    solver->advance(steps);
    return solver->state();
}

/// What happened over frames from rest.
struct Course {
    double notFinite = 0;       // frames
    double farthest = 0;        // h: of a node from rest
    double mostKinetic = 0;     // J
    double lastKinetic = 0;     // J: most in the last tenth of the frames
    double energyGain = -1e300; // J: most of all energy over that of the start
    sim::LatticeState last;
};

Course play(const sim::SolverSetup& setup, sim::Solver& solver, int frames) {
    const sim::LatticeState rest = sim::restState(*setup.lattice);
    const sim::Energies start = sim::energies(setup, rest);
    Course course;
    solver.setState(sim::startState(setup));
    for (int frame = 1; frame <= frames; ++frame) {
        solver.advance(1);
        course.last = solver.state();
        const sim::Energies now = sim::energies(setup, course.last);
        const double sum = now.kinetic + now.elastic + now.gravitational;
        course.notFinite += !std::isfinite(sum);
        const double moved = largestDistance(course.last, rest);
        course.farthest = moved <= course.farthest ? course.farthest : moved;
        course.mostKinetic = std::max(course.mostKinetic, now.kinetic);
        if (10 * frame > 9 * frames)
            course.lastKinetic = std::max(course.lastKinetic, now.kinetic);
        course.energyGain = std::max(course.energyGain, sum - start.gravitational);
    }
    return course;
}

/// 300 frames, with --full 10,000: what explicit steps would take more than a thousand a frame for.
Status stiffCapsule(const VerifyOptions& options, CheckList& checks) {
    const auto body = capsuleBody(12);
    const int frames = options.full ? 10000 : 300;
    const sim::StableStep step = sim::stableStep(body->lattice, body->setup.tissue, kImplicitFrame);
    checks.atLeast("capsule of 1 MPa around 1 kPa: explicit steps that a frame would take",
                   step.stepsPerFrame, 1000, "");
    const sim::LatticeState atRest = settled(body->setup, 200);
    const double sag = largestDistance(atRest, sim::restState(body->lattice));
    for (const std::string& name : comparedSolvers(options)) {
        if (name == "fragment" && options.solver.empty() &&
            !options.full) // takes the same steps as compute, by the same passes
            continue;
        const sim::SolverSetup setup = checkedSetup(options, body->setup);
        SEROSA_ASSIGN(const auto solver, makeSolver(name, setup));
        const bool whole = name == "cpu"; // textures are stepped by the CPU where there is no GPU
        const int count = whole ? frames : options.full ? 1000 : 30;
        const Course course = play(setup, *solver, count);
        const std::string of = "capsule, " + std::to_string(count) + " frames, " + name + ": ";
        checks.equalAbs(of + "frames that are not finite", course.notFinite, 0, 0, "");
        checks.atMost(of + "farthest that a node was from rest, over the sag", course.farthest / sag, 2.2,
                      "1");
        checks.atMost(of + "energy beyond that of the start", course.energyGain, 1e-9, "J");
        if (!whole && !options.full)
            continue;
        checks.atMost(of + "kinetic energy in the last tenth, over the largest",
                      course.lastKinetic / course.mostKinetic, 1e-3, "1");
        checks.atMost(of + "distance from where the reference comes to rest, over the sag",
                      largestDistance(course.last, atRest) / sag, 0.01, "1");
    }
    return {};
}

/// Held at one end, at rest after 3 s of explicit steps in air that brakes, and after 300 implicit ones. Most
/// of the difference is what 3 s have left of the swing.
void restingSag(const VerifyOptions& options, const ImplicitBody& body, const std::string& what,
                CheckList& checks) {
    sim::SolverSetup twin = body.withExplicitSteps();
    twin.tissue.airDrag = 20; // 1/s
    const sim::LatticeState expected = settled(twin, int(3 / twin.timeStep));
    const double sag = largestDistance(expected, sim::restState(body.lattice));
    checks.atLeast(what + ", explicit reference: sag", sag, 0.1, "h");
    std::vector<std::string> names = longSolvers(options);
    names.push_back("reference");
    for (const std::string& name : names) {
        const sim::SolverSetup setup = checkedSetup(options, body.setup);
        const Result<std::unique_ptr<sim::Solver>> solver = makeSolver(name, setup);
        if (!solver.ok()) {
            checks.skip(what + ", " + name, solver.error().message);
            continue;
        }
        (*solver)->setState(sim::startState(setup));
        (*solver)->advance(300);
        checks.atMost(what + ", " + name + ": farthest from the explicit reference at rest, over the sag",
                      largestDistance((*solver)->state(), expected) / sag, 0.01, "1");
    }
}

Status statics(const VerifyOptions& options, CheckList& checks) {
    for (const double poisson : {0.25, 0.45}) {
        ImplicitBody beam(blockOfCells({8, 3, 3}, 0.005), 20000);
        beam.setup.tissue.poisson = poisson;
        beam.fixWhere([](const glm::ivec3& node) { return node.x == 0; });
        restingSag(options, beam, "beam of 20 kPa, nu " + shortNumber(poisson), checks);
    }
    if (options.full) // a thousand explicit steps a frame
        restingSag(options, *capsuleBody(8), "capsule of 1 MPa around 1 kPa", checks);
    return {};
}

/// A beam of 1 MPa and 12 cm on a hinge, let go at 75 degrees.
Status pendulum(const VerifyOptions& options, CheckList& checks) {
    ImplicitBody beam(blockOfCells({12, 3, 3}, 0.01), 1e6);
    beam.setup.tissue.dampingTime = 0.0005;
    beam.fixWhere([](const glm::ivec3& node) { return node.x == 0 && node.y == 3; });
    const glm::dvec3 hinge = beam.lattice.toLattice({0, 0.03, 0.015});
    std::vector<std::string> names = longSolvers(options);
    names.push_back("reference");
    for (const std::string& name : names) {
        SEROSA_ASSIGN(const auto solver, makeSolver(name, beam.setup));
        solver->setState(sim::startState(beam.setup));
        const auto angle = [&] {
            glm::dvec3 sum(0);
            double mass = 0;
            const sim::LatticeState state = solver->state();
            for (std::size_t i = 0; i < state.positions.size(); ++i) {
                sum += beam.lattice.massShare(i) * state.positions[i];
                mass += beam.lattice.massShare(i);
            }
            const glm::dvec3 from = sum / mass - hinge;
            return std::atan2(from.x, -from.y);
        };
        const double start = angle();
        double least = start, back = 0;
        for (int frame = 0; frame < 55; ++frame) { // more than one period, less than two
            solver->advance(1);
            least = std::min(least, angle());
            if (least < -0.5)
                back = std::max(back, angle());
        }
        const std::string of = "pendulum of 1 MPa, " + name + ": angle ";
        checks.atLeast(of + "on the other side, over that of the start", -least / start, 0.9, "1");
        checks.atLeast(of + "after one period, over that of the start", back / start, 0.8, "1");
        checks.atMost(of + "after one period, over that of the start", back / start, 1, "1");
    }
    return {};
}

/// The reference solves each step as far as double goes, the others as far as a frame has time for.
Status agreement(const VerifyOptions& options, CheckList& checks) {
    const auto body = capsuleBody(options.full ? 16 : 10);
    const int frames = 12;
    const sim::LatticeState expected = settled(body->setup, frames);
    checks.atLeast("capsule, reference: moved after 12 frames",
                   largestDistance(expected, sim::restState(body->lattice)), 0.1, "h");
    for (const std::string& name : comparedSolvers(options)) {
        const sim::SolverSetup setup = checkedSetup(options, body->setup);
        const std::string of = "capsule, " + name + ": ";
        std::string hash;
        for (const bool again : {false, true}) {
            SEROSA_ASSIGN(const auto solver, makeSolver(name, setup));
            solver->setState(sim::startState(setup));
            solver->advance(frames);
            if (again) {
                checks.equalAbs(of + "same bytes on a second run", solver->state().hash() == hash ? 0 : 1, 0,
                                0, "");
                continue;
            }
            hash = solver->state().hash();
            checks.atMost(of + "against reference after 12 frames",
                          largestDistance(solver->state(), expected), 2e-3, "h");
        }
    }
    return {};
}

} // namespace

Status verifyImplicit(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(stiffCapsule(options, checks));
    SEROSA_TRY(statics(options, checks));
    SEROSA_TRY(pendulum(options, checks));
    SEROSA_TRY(agreement(options, checks));
    return verifyImplicitScenarios(options, checks);
}

} // namespace serosa::app
