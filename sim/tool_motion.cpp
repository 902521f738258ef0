// What touches is the organ's surface, not its nodes: those of partly filled cells lie up to a spacing
// outside of it and may enter a tool by as much, those inside are kept off it by their depth. Without that
// the weak outer cells are crushed flat between a tool and the full ones below, and fold. Grasped nodes move
// with their tool.
#include "sim/tool_motion.h"

#include "shaders/shared_constants.h"
#include "sim/contact_point.h"
#include "sim/shape_distance.h"

namespace serosa::sim {

glm::dvec3 ToolMotion::apply(const glm::dvec3& x, const glm::dvec3& free, bool held, double depth) const {
    if (mode == SRS_TOOL_GRASP)
        return held ? carried(x) : free;
    if (mode != SRS_TOOL_PUSH)
        return free;
    const ContactShape collider{shape, thinnestHalfWidth(shape), friction};
    const glm::dvec3 y0 = ownAtStart(x), y1 = ownAtEnd(free);
    const glm::dvec3 move = pointContact(collider, y0, y1, contactDepthFor(depth, collider.thin),
                                         sweepSamples(glm::distance(y0, y1), collider.thin));
    return free + turnTo * move;
}

std::vector<ToolMotion> toolMotions(const SolverSetup& setup, std::int64_t step) {
    const double start = double(step) * setup.timeStep, end = double(step + 1) * setup.timeStep;
    const double tick = 1e-6 * setup.timeStep; // keys at a step's time count as reached
    std::vector<ToolMotion> motions;
    for (const Tool& tool : setup.tools) {
        ToolMotion motion;
        const RigidPose from = tool.poseAt(start), to = tool.poseAt(end);
        motion.from = setup.lattice->toLattice(from.at);
        motion.to = setup.lattice->toLattice(to.at);
        motion.turnFrom = from.turn;
        motion.turnTo = to.turn;
        motion.shape = scaledShape(tool.wholeShape(), 1 / setup.lattice->spacing);
        motion.friction = tool.friction;
        motion.grip = tool.gripForce * setup.timeStep * setup.timeStep /
                      (setup.tissue.nodeMass(setup.lattice->spacing) * setup.lattice->spacing);
        const bool active = tool.activeAt(start + tick);
        if (tool.mode == ToolMode::push) {
            motion.mode = active ? SRS_TOOL_PUSH : SRS_TOOL_NONE;
        } else {
            const bool before = step > 0 && tool.activeAt(double(step - 1) * setup.timeStep + tick);
            motion.mode = active ? SRS_TOOL_GRASP : SRS_TOOL_NONE;
            motion.closes = active && !before;
            motion.opens = !active && before;
        }
        motions.push_back(motion);
    }
    return motions;
}

std::vector<ToolMotion> colliderMotions(const SolverSetup& setup, std::int64_t step, StepPart part) {
    std::vector<ToolMotion> motions = toolMotions(setup, step);
    for (ToolMotion& motion : motions) {
        const RigidPose start{motion.from, motion.turnFrom}, end{motion.to, motion.turnTo};
        const auto at = [&](double share) { return share < 1 ? poseBetween(start, end, share) : end; };
        const RigidPose first = part.from > 0 ? at(part.from) : start, last = at(part.to);
        motion.from = first.at;
        motion.turnFrom = first.turn;
        motion.to = last.at;
        motion.turnTo = last.turn;
    }
    for (const Body& body : setup.bodies) {
        ToolMotion motion;
        motion.mode = SRS_TOOL_PUSH;
        motion.from = motion.to = setup.lattice->toLattice(body.pose.at);
        motion.turnFrom = motion.turnTo = body.pose.turn;
        motion.shape = scaledShape(body.shape, 1 / setup.lattice->spacing);
        motion.friction = body.friction;
        motions.push_back(motion);
    }
    return motions;
}

bool graspReaches(const ToolMotion& tool, const glm::dvec3& x) {
    return shapeDistance(tool.shape, tool.ownAtStart(x)) < 0;
}

void updateHeldNodes(const SolverSetup& setup, const std::vector<ToolMotion>& tools, LatticeState& state) {
    for (std::size_t tool = 0; tool < tools.size(); ++tool) {
        if (!tools[tool].closes && !tools[tool].opens)
            continue;
        for (std::size_t node = 0; node < state.positions.size(); ++node) {
            std::uint32_t& holder = state.heldBy[node];
            if (tools[tool].opens && holder == tool + 1)
                holder = 0;
            const bool fixed = !setup.fixed.empty() && setup.fixed[node];
            if (tools[tool].closes && holder == 0 && !fixed &&
                graspReaches(tools[tool], state.positions[node]))
                holder = std::uint32_t(tool + 1);
        }
    }
}

} // namespace serosa::sim
