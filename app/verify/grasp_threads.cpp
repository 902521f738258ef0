// The part of the group `grasp` about threads (sim/thread_hold.h): two blocks, one above the other, are tied
// together, and forceps pull the upper one away. What the thread carries is what they give; a thread a little
// stronger than that holds, one a little weaker breaks, at its strength.
#include "app/solver_choice.h"
#include "app/verify/contact_pieces.h"
#include "sim/organ_group.h"

#include <cmath>
#include <limits>

namespace serosa::app {

namespace {

constexpr double kSide = 0.012;            // m, of the blocks
constexpr double kPull = 0.4, kHold = 0.7; // s: pulled until then, held until then

struct Pulled {
    double forceps = 0; // N: mean over the last 5 ms, or over those before it broke
    double thread = 0;  // N: at the end
    double most = 0;    // N: largest of the averages
    bool broken = false;
};

Result<Pulled> pullApart(const std::string& name, double strength, const sim::Tissue& tissue) {
    ContactPiece low({3, 3, 3}, kSide / 3, glm::dvec3(0), tissue),
        high({4, 4, 4}, kSide / 4, glm::dvec3(0, 2 * kSide, 0), tissue);
    for (const glm::ivec3& node : low.lattice.nodes)
        low.setup.fixed.push_back(node.y == 0);
    sim::Tool forceps;
    forceps.name = "forceps";
    forceps.mode = sim::ToolMode::grasp;
    forceps.radius = forceps.shape.radius = 0.5 * kSide;
    const glm::dvec3 grip(0.5 * kSide, 3 * kSide, 0.5 * kSide), up(0, 0.5 * kSide, 0);
    forceps.keys = {{0, grip}, {kPull, grip + up}, {10, grip + up}};
    high.setup.tools = {forceps};
    low.setup.timeStep = high.setup.timeStep = std::min(low.setup.timeStep, high.setup.timeStep);
    SEROSA_ASSIGN(const auto first, makeSolver(name, low.setup));
    SEROSA_ASSIGN(const auto second, makeSolver(name, high.setup));
    sim::TiedThread tied;
    tied.thread.strength = strength;
    tied.organs[1] = 1;
    double outside = 0;
    const glm::dvec3 from(0.5 * kSide, kSide, 0.5 * kSide), to(0.5 * kSide, 2 * kSide, 0.5 * kSide);
    tied.anchors[0] = sim::anchorAt(low.lattice, from, outside);
    tied.anchors[1] = sim::anchorAt(high.lattice, to, outside);
    tied.thread.length = glm::distance(from, to);
    SEROSA_ASSIGN(
        const auto group,
        sim::OrganGroup::create({{first.get(), false, false}, {second.get(), false, false}}, {0, {tied}}));
    const double step = low.setup.timeStep;
    const int steps = std::max(1, int(0.005 / step));
    Pulled pulled;
    for (double time = 0; time < kHold && !pulled.broken; time += steps * step) {
        second->takeLoads();
        group->advance(steps);
        const sim::ThreadState state = group->threads()[0];
        pulled.broken = state.broken;
        pulled.thread = state.force;
        pulled.most = state.mostForce;
        if (!state.broken)
            pulled.forceps = second->takeLoads()[0].impulse.y / (steps * step);
    }
    return pulled;
}

} // namespace

Status verifyThreads(const VerifyOptions& options, CheckList& checks) {
    sim::Tissue tissue;
    tissue.dampingTime = 0.002;
    tissue.airDrag = 20; // 1e-4 N on the block that moves
    std::vector<std::string> names = comparedSolvers(options);
    names.push_back("reference");
    for (const std::string& name : names) {
        const std::string of = "blocks tied and pulled apart, " + name + ": ";
        SEROSA_ASSIGN(const Pulled whole, pullApart(name, std::numeric_limits<double>::infinity(), tissue));
        checks.equalRel(of + "the thread carries what the forceps give", whole.thread, whole.forceps, 0.01,
                        "N");
        SEROSA_ASSIGN(const Pulled holds, pullApart(name, 1.1 * whole.most, tissue));
        checks.equalRel(of + "a thread of 1.1 times that holds, and carries", holds.thread, whole.thread,
                        0.001, "N");
        checks.atMost(of + "it is broken (1) or not (0)", holds.broken, 0, "1");
        const double strength = whole.most / 1.5;
        SEROSA_ASSIGN(const Pulled breaks, pullApart(name, strength, tissue));
        checks.atLeast(of + "a thread of two thirds is broken (1) or not (0)", breaks.broken, 1, "1");
        checks.equalRel(of + "the forceps' force as it broke", breaks.forceps, strength, 0.1, "N");
        checks.atLeast(of + "it carried, over its strength", breaks.most / strength, 1, "1");
        checks.atMost(of + "it broke at, over its strength", breaks.most / strength, 1.1, "1");
    }
    return {};
}

} // namespace serosa::app
