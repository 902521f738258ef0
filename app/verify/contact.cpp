// Group `contact`: what touches an organ does to it what mechanics says. A ball falls on a floor as the
// reference has it, a block slides down a slope from tan(angle) = mu on (Coulomb); the parts of it in other
// files: impulses against momenta, probes that must not pass a thin sheet, organs that touch each other.
#include "app/organ_setup.h"
#include "app/solver_choice.h"
#include "app/verify/contact_pieces.h"
#include "models/phantom.h"

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

/// Height of the centre of mass over time, m, every few steps.
std::vector<double> heights(const ContactPiece& piece, sim::Solver& solver, double seconds) {
    constexpr int kStepsAtOnce = 4;
    solver.setState(sim::startState(piece.setup));
    std::vector<double> all{piece.centre(solver.state()).y};
    for (double time = 0; time < seconds; time += kStepsAtOnce * piece.setup.timeStep) {
        solver.advance(kStepsAtOnce);
        all.push_back(piece.centre(solver.state()).y);
    }
    return all;
}

struct Bounce {
    double top = 0;  // m: highest after the first impact, over the height at rest
    double rest = 0; // m: mean height of the last tenth
};

Bounce bounceOf(const std::vector<double>& heights) {
    Bounce bounce;
    const std::size_t last = heights.size() - heights.size() / 10;
    for (std::size_t i = last; i < heights.size(); ++i)
        bounce.rest += heights[i] / double(heights.size() - last);
    const auto impact = std::is_sorted_until(heights.begin(), heights.end(), std::greater<>());
    bounce.top = *std::max_element(impact, heights.end()) - bounce.rest;
    return bounce;
}

/// A ball of tissue, 40 mm across, falls 20 mm.
Status droppedBall(const VerifyOptions& options, CheckList& checks) {
    SEROSA_ASSIGN(sim::Lattice lattice, models::phantomLattice("ball", 3380, options.full ? 3000 : 600));
    sim::Tissue tissue;
    tissue.young = 20000;
    tissue.dampingTime = 0.002;
    ContactPiece piece(std::move(lattice), tissue);
    double low = 1e9;
    for (std::size_t node = 0; node < piece.lattice.nodeCount(); ++node)
        low = std::min(low, piece.lattice.toWorld(piece.lattice.restPosition(node)).y);
    piece.setup.gravity = {0, -9.81, 0};
    piece.setup.bodies = {floorAt(low - 0.02, 0.3)};
    const double seconds = 1.2;
    const auto reference = sim::makeReferenceSolver(piece.setup);
    const std::vector<double> path = heights(piece, *reference, seconds);
    const Bounce expected = bounceOf(path);
    checks.atLeast("ball dropped 20 mm, reference: bounces to", 1e3 * expected.top, 0.5, "mm");
    checks.atMost("ball dropped 20 mm, reference: bounces to", 1e3 * expected.top, 20, "mm");
    if (options.inject.fault == Fault::stiffness)
        piece.setup.tissue.young *= options.inject.factor;
    for (const std::string& name : comparedSolvers(options)) {
        SEROSA_ASSIGN(const auto solver, makeSolver(name, piece.setup));
        const Bounce got = bounceOf(heights(piece, *solver, seconds));
        checks.equalRel("ball dropped 20 mm, " + name + ": bounce", 1e3 * got.top, 1e3 * expected.top, 0.02,
                        "mm");
        checks.equalRel("ball dropped 20 mm, " + name + ": height at rest over the floor",
                        1e3 * (got.rest - piece.setup.bodies[0].pose.at.y),
                        1e3 * (expected.rest - piece.setup.bodies[0].pose.at.y), 0.02, "mm");
    }
    return {};
}

/// How far a block gets on a slope between 0.25 and 0.5 s, m, and the speed that it gains meanwhile, m/s.
struct Slide {
    double way = 0, gain = 0;
};
Slide slide(ContactPiece& piece, const std::string& name, double tangent, double seconds, Status& status) {
    // The floor is level and gravity leans: the same, and the block lies along the lattice.
    const double angle = std::atan(tangent);
    piece.setup.gravity = 9.81 * glm::dvec3(std::sin(angle), -std::cos(angle), 0);
    Result<std::unique_ptr<sim::Solver>> made = makeSolver(name, piece.setup);
    if (!made.ok()) {
        status = made.error();
        return {};
    }
    sim::Solver& solver = **made;
    solver.setState(sim::startState(piece.setup));
    const int steps = int(0.5 * seconds / piece.setup.timeStep);
    solver.advance(steps); // settles
    const sim::LatticeState before = solver.state();
    solver.advance(steps);
    const sim::LatticeState after = solver.state();
    return {piece.centre(after).x - piece.centre(before).x,
            (piece.momentum(after).x - piece.momentum(before).x) / piece.totalMass()};
}

Status slopes(const VerifyOptions& options, CheckList& checks) {
    sim::Tissue tissue;
    tissue.young = 20000;
    tissue.dampingTime = 0.002;
    for (const double mu : {0.3, 0.8}) {
        ContactPiece piece({8, 3, 6}, 0.005, glm::dvec3(0), tissue);
        piece.setup.bodies = {floorAt(0, mu)};
        const double seconds = options.full ? 1 : 0.5;
        std::vector<std::string> names = comparedSolvers(options);
        names.push_back("reference");
        for (const std::string& name : names) {
            const std::string of = "block on a slope, mu " + shortNumber(mu) + ", " + name + ": ";
            Status status;
            const Slide held = slide(piece, name, 0.95 * mu, seconds, status);
            const Slide slides = slide(piece, name, 1.05 * mu, seconds, status);
            SEROSA_TRY(status);
            checks.atMost(of + "way at tan 0.95 mu", 1e3 * std::abs(held.way), 0.01, "mm");
            // a = g (sin - mu cos): the coefficient that the motion shows.
            const double angle = std::atan(1.05 * mu);
            const int steps = int(0.5 * seconds / piece.setup.timeStep);
            const double acceleration = slides.gain / (steps * piece.setup.timeStep);
            checks.equalRel(of + "coefficient by the acceleration at tan 1.05 mu",
                            std::tan(angle) - acceleration / (9.81 * std::cos(angle)), mu, 0.05 * 0.5, "1");
            checks.atLeast(of + "way at tan 1.05 mu", 1e3 * slides.way, 0.5, "mm");
        }
    }
    return {};
}

} // namespace

Status verifyContact(const VerifyOptions& options, CheckList& checks) {
    SEROSA_TRY(droppedBall(options, checks));
    SEROSA_TRY(slopes(options, checks));
    SEROSA_TRY(verifyContactImpulses(options, checks));
    SEROSA_TRY(verifyOrganContact(options, checks));
    return verifyProbes(options, checks);
}

} // namespace serosa::app
