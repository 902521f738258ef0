// Part of group `contact`: what tools and bodies say that they gave is what a free organ got, as momentum and
// as angular momentum.
#include "app/organ_setup.h"
#include "app/solver_choice.h"
#include "app/verify/contact_pieces.h"
#include "app/verify/random_scenario.h"

#include <cmath>

namespace serosa::app {

namespace {

constexpr double kSpacing = 0.004; // m

sim::Tissue softTissue() {
    sim::Tissue tissue;
    tissue.dampingTime = 0.001;
    return tissue;
}

struct Shape {
    const char* name;
    sim::RigidShape shape;
};

std::vector<Shape> shapes() {
    sim::RigidShape sphere, capsule, box, hook;
    sphere.radius = 0.008;
    capsule.kind = sim::ShapeKind::capsule;
    capsule.radius = 0.003;
    capsule.length = 0.05;
    box.kind = sim::ShapeKind::box;
    box.radius = 0.0005;
    box.halfSize = {0.008, 0.0005, 0.01};
    hook.kind = sim::ShapeKind::hook;
    hook.radius = 0.002;
    hook.bend = 0.006;
    hook.length = 0.03;
    return {{"sphere", sphere}, {"capsule", capsule}, {"blade", box}, {"hook", hook}};
}

/// A tool strikes a free block, turning as it comes.
Status pushed(const Shape& shape, const std::string& name, CheckList& checks) {
    ContactPiece piece({7, 6, 5}, kSpacing, glm::dvec3(-0.014, -0.012, -0.01), softTissue());
    sim::Tool tool;
    tool.name = shape.name;
    tool.shape = shape.shape;
    tool.radius = shape.shape.radius;
    tool.friction = 0.4;
    const glm::dquat first = glm::angleAxis(0.3, glm::normalize(glm::dvec3(1, 2, 3))),
                     second = glm::angleAxis(0.9, glm::normalize(glm::dvec3(1, 1, 0)));
    tool.keys = {{0, {-0.002, 0.035, 0.003}, first}, {0.08, {0.003, 0.006, -0.001}, second}};
    piece.setup.tools = {tool};
    SEROSA_ASSIGN(const auto solver, makeSolver(name, piece.setup));
    solver->advance(int(0.1 / piece.setup.timeStep));
    const glm::dvec3 given = solver->takeLoads()[0].impulse, got = piece.momentum(solver->state());
    const std::string of = std::string("free block, ") + shape.name + ", " + name + ": ";
    checks.atLeast(of + "momentum", 1e3 * glm::length(got), 0.1, "g m/s");
    checks.atMost(of + "the tool's impulse off the momentum gained",
                  glm::distance(given, got) / glm::length(got), 1e-3, "1");
    return {};
}

/// A block is thrown at a body: both linear and angular momentum.
Status thrown(const std::string& name, CheckList& checks) {
    ContactPiece piece({6, 6, 6}, kSpacing, glm::dvec3(-0.012), softTissue());
    sim::Body body;
    body.name = "rod";
    body.shape.kind = sim::ShapeKind::capsule;
    body.shape.radius = 0.004;
    body.shape.length = 0.08;
    body.pose.at = {0.021, 0.006, -0.04};
    body.friction = 0.5;
    piece.setup.bodies = {body};
    SEROSA_ASSIGN(const auto solver, makeSolver(name, piece.setup));
    sim::LatticeState start = sim::startState(piece.setup);
    for (glm::dvec3& increment : start.increments)
        increment += glm::dvec3(0.6, 0.1, 0) * piece.setup.timeStep / kSpacing;
    solver->setState(start);
    const sim::LatticeState before = solver->state();
    solver->advance(int(0.08 / piece.setup.timeStep));
    const sim::LatticeState after = solver->state();
    const sim::ToolLoad load = solver->takeLoads()[0];
    const glm::dvec3 gained = piece.momentum(after) - piece.momentum(before),
                     turned = piece.angularMomentum(after, body.pose.at) -
                              piece.angularMomentum(before, body.pose.at);
    const std::string of = "block thrown at a rod, " + name + ": ";
    checks.atLeast(of + "momentum changed by", 1e3 * glm::length(gained), 1, "g m/s");
    checks.atMost(of + "the rod's impulse off it", glm::distance(load.impulse, gained) / glm::length(gained),
                  1e-3, "1");
    checks.atMost(of + "the rod's angular impulse off the change of angular momentum",
                  glm::distance(load.angular, turned) / glm::length(turned), 1e-3, "1");
    return {};
}

} // namespace

Status verifyContactImpulses(const VerifyOptions& options, CheckList& checks) {
    std::vector<std::string> names = comparedSolvers(options);
    names.push_back("reference");
    for (const std::string& name : names) {
        for (const Shape& shape : shapes())
            SEROSA_TRY(pushed(shape, name, checks));
        SEROSA_TRY(thrown(name, checks));
    }
    return {};
}

} // namespace serosa::app
