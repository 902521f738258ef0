// Group `grasp`: what holds tissue holds as hard as it says and no harder. A bar is pulled by a jaw until it
// slips; a grasp that turns gives a torque; several tools hold at once; a retractor holds its pose under
// load.
#include "app/organ_setup.h"
#include "app/solver_choice.h"
#include "app/verify/contact_pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace serosa::app {

namespace {

constexpr double kSpacing = 0.004; // m

sim::Tissue barTissue(const VerifyOptions& options) {
    sim::Tissue tissue;
    tissue.dampingTime = 0.002;
    if (options.inject.fault == Fault::stiffness)
        tissue.young *= options.inject.factor;
    return tissue;
}

/// 12 x 4 x 4 cells along x, held at x = 0.
std::unique_ptr<ContactPiece> makeBar(const VerifyOptions& options) {
    auto bar = std::make_unique<ContactPiece>(glm::ivec3(12, 4, 4), kSpacing,
                                              glm::dvec3(0, -2, -2) * kSpacing, barTissue(options));
    for (const glm::ivec3& node : bar->lattice.nodes)
        bar->setup.fixed.push_back(node.x == 0);
    return bar;
}

/// Pads around the last cells of the bar, closed at t = 0.
sim::Tool jaws(double grip) {
    sim::Tool tool;
    tool.name = "jaws";
    tool.mode = sim::ToolMode::grasp;
    tool.shape.kind = sim::ShapeKind::box;
    tool.shape.halfSize = glm::dvec3(1.4, 3, 3) * kSpacing;
    tool.radius = 0.0001;
    tool.gripForce = grip;
    return tool;
}

/// Largest mean force over a sixtieth of a second, and that at the end, N along x.
struct Pull {
    double most = 0, last = 0;
};
Result<Pull> pull(const ContactPiece& bar, const std::string& name, double seconds) {
    SEROSA_ASSIGN(const auto solver, makeSolver(name, bar.setup));
    const int steps = std::max(1, int(1.0 / 60 / bar.setup.timeStep));
    Pull result;
    solver->takeLoads();
    for (double time = 0; time < seconds; time += steps * bar.setup.timeStep) {
        solver->advance(steps);
        result.last = solver->takeLoads()[0].impulse.x / (steps * bar.setup.timeStep);
        result.most = std::max(result.most, result.last);
    }
    return result;
}

/// Slips at its force: pulled by a slip-free grasp the bar would give three times as much.
Status slips(const VerifyOptions& options, const std::string& name, CheckList& checks) {
    const auto bar = makeBar(options);
    const glm::dvec3 at = glm::dvec3(12, 0, 0) * kSpacing;
    const double seconds = options.full ? 1.5 : 0.75, way = 0.02;
    sim::Tool tool = jaws(std::numeric_limits<double>::infinity());
    tool.keys = {{0, at}, {seconds, at + glm::dvec3(way, 0, 0)}, {10, at + glm::dvec3(way, 0, 0)}};
    bar->setup.tools = {tool};
    SEROSA_ASSIGN(const Pull firm, pull(*bar, name, seconds));
    const std::string of = "bar pulled by jaws, " + name + ": ";
    const double grip = firm.most / 3;
    bar->setup.tools[0].gripForce = grip;
    SEROSA_ASSIGN(const Pull weak, pull(*bar, name, seconds));
    checks.equalRel(of + "largest force with a third of the grip that it would take", weak.most, grip, 0.1,
                    "N");
    bar->setup.tools[0].gripForce = 2 * firm.most;
    SEROSA_ASSIGN(const Pull holds, pull(*bar, name, seconds));
    checks.equalRel(of + "largest force with twice the grip that it takes", holds.most, firm.most, 0.01, "N");
    return {};
}

/// A square bar is twisted by a grasp: the torque at rest is that of the bar's end.
Status twists(const VerifyOptions& options, const std::string& name, CheckList& checks) {
    const auto bar = makeBar(options);
    const glm::dvec3 at = glm::dvec3(12, 0, 0) * kSpacing;
    sim::Tool tool = jaws(std::numeric_limits<double>::infinity());
    const double angle = 0.2, turning = 0.3, seconds = 1;
    tool.keys = {{0, at},
                 {turning, at, glm::angleAxis(angle, glm::dvec3(1, 0, 0))},
                 {10, at, glm::angleAxis(angle, glm::dvec3(1, 0, 0))}};
    bar->setup.tools = {tool};
    SEROSA_ASSIGN(const auto solver, makeSolver(name, bar->setup));
    solver->advance(int(seconds / bar->setup.timeStep));
    solver->takeLoads();
    const int steps = int(0.05 / bar->setup.timeStep);
    solver->advance(steps);
    const sim::ToolLoad load = solver->takeLoads()[0];
    // Saint-Venant: mu J angle / length; J = 0.1406 a^4, mu = 0.4 E. The free length ends at the first held
    // section, and the clamped ends keep the section from warping, which stiffens so short a bar.
    const double side = 4 * kSpacing, length = 11 * kSpacing;
    const double torque = 0.4 * barTissue({}).young * 0.1406 * std::pow(side, 4) * angle / length;
    const std::string of = "bar twisted by jaws, " + name + ": ";
    checks.equalRel(of + "torque, Saint-Venant", 1e3 * load.angular.x / (steps * bar->setup.timeStep),
                    1e3 * torque, 0.25, "mN m");
    checks.atMost(of + "force aside over torque / side",
                  glm::length(load.impulse) * side / std::abs(load.angular.x), 0.5, "1");
    return {};
}

/// Two grasps pull the free ends of a bar apart: each gives what the other does.
Status twoGrasps(const VerifyOptions& options, const std::string& name, CheckList& checks) {
    const auto bar = makeBar(options);
    bar->setup.fixed.clear();
    const double seconds = 0.8, way = 0.002;
    for (const double end : {0.0, 12.0}) {
        sim::Tool tool = jaws(std::numeric_limits<double>::infinity());
        const glm::dvec3 at = glm::dvec3(end, 0, 0) * kSpacing, out((end > 0 ? 0.5 : -0.5) * way, 0, 0);
        tool.keys = {{0, at}, {0.3, at + out}, {10, at + out}};
        bar->setup.tools.push_back(tool);
    }
    SEROSA_ASSIGN(const auto solver, makeSolver(name, bar->setup));
    solver->advance(int(seconds / bar->setup.timeStep));
    solver->takeLoads();
    const int steps = int(0.1 / bar->setup.timeStep);
    solver->advance(steps);
    const std::vector<sim::ToolLoad> loads = solver->takeLoads();
    const std::string of = "bar between two grasps, " + name + ": ";
    const double force = loads[1].impulse.x / (steps * bar->setup.timeStep);
    // Between the inner held sections: 12 - 2 cells of the bar carry the stretch.
    const double strain = way / (10 * kSpacing), area = std::pow(4 * kSpacing, 2);
    checks.equalRel(of + "force, E A strain", force, barTissue({}).young * area * strain, 0.15, "N");
    checks.atMost(of + "sum of both over one",
                  glm::length(loads[0].impulse + loads[1].impulse) / glm::length(loads[1].impulse), 2e-3,
                  "1");
    return {};
}

/// A hook and a blade pull a bar's middle down and wait: the tissue comes to rest on them.
Status holdsPose(const VerifyOptions& options, const std::string& name, CheckList& checks) {
    for (const bool hook : {true, false}) {
        const auto bar = makeBar(options);
        for (std::size_t node = 0; node < bar->setup.fixed.size(); ++node)
            bar->setup.fixed[node] = bar->lattice.nodes[node].x == 0 || bar->lattice.nodes[node].x == 12;
        sim::Tool tool;
        tool.name = hook ? "hook" : "blade";
        tool.friction = 0.3;
        const glm::dvec3 middle = glm::dvec3(6, 0, 0) * kSpacing;
        glm::dquat turn(1, 0, 0, 0);
        double above = 0;
        if (hook) { // around the bar from the far side, in the plane across it
            tool.radius = 0.0015;
            tool.shape.kind = sim::ShapeKind::hook;
            tool.shape.bend = 0.014;
            tool.shape.length = 0.05;
            above = 0.001;
        } else { // its edge under the bar
            tool.radius = 0.0005;
            tool.shape.kind = sim::ShapeKind::box;
            tool.shape.halfSize = {0.006, 0.02, 0.001};
            turn = glm::angleAxis(std::numbers::pi / 2, glm::dvec3(1, 0, 0));
            turn = glm::dquat(1, 0, 0, 0);
        }
        const double pulled = 0.006;
        glm::dvec3 from, to;
        if (hook) {
            // Own z up: the bend lies below, and lifts the bar when it rises.
            turn = glm::angleAxis(-std::numbers::pi / 2, glm::dvec3(1, 0, 0)); // own z -> world y
            from = middle + glm::dvec3(0, above + 0.002, 0);
            to = from + glm::dvec3(0, pulled + 0.002, 0);
        } else {
            turn = glm::angleAxis(std::numbers::pi / 2, glm::dvec3(1, 0, 0));
            from = middle - glm::dvec3(0, 2 * kSpacing + 0.002 + 0.002, 0);
            to = from + glm::dvec3(0, pulled + 0.002, 0);
        }
        tool.keys = {{0, from, turn}, {0.4, to, turn}};
        bar->setup.tools = {tool};
        SEROSA_ASSIGN(const auto solver, makeSolver(name, bar->setup));
        solver->advance(int(1.2 / bar->setup.timeStep));
        solver->takeLoads();
        const int steps = int(0.05 / bar->setup.timeStep);
        solver->advance(steps);
        const double first = solver->takeLoads()[0].impulse.y / (steps * bar->setup.timeStep);
        solver->advance(10 * steps);
        solver->takeLoads();
        solver->advance(steps);
        const double second = solver->takeLoads()[0].impulse.y / (steps * bar->setup.timeStep);
        const std::string of = "bar lifted by a " + tool.name + ", " + name + ": ";
        checks.atLeast(of + "force", first, 0.005, "N");
        checks.equalRel(of + "force half a second later", second, first, 0.02, "N");
    }
    return {};
}

} // namespace

Status verifyGrasp(const VerifyOptions& options, CheckList& checks) {
    std::vector<std::string> names = comparedSolvers(options);
    names.push_back("reference");
    for (const std::string& name : names) {
        SEROSA_TRY(slips(options, name, checks));
        SEROSA_TRY(twists(options, name, checks));
        SEROSA_TRY(twoGrasps(options, name, checks));
        SEROSA_TRY(holdsPose(options, name, checks));
    }
    return verifyThreads(options, checks);
}

} // namespace serosa::app
