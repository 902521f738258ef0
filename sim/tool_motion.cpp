// Contact moves a node out of the sphere along the normal that it had at the step's start; the increment that
// follows from it ends the approach and keeps the slide. Relative to the tool a node then never moves further
// than it would have without contact: along the radius at the end of the step, a fast node that crosses a
// part of the sphere would leave it with more energy than it came with. What lies inside already, let go by a
// grasp there, comes out slowly, not in one step. What touches is the organ's surface, not its nodes: those
// of partly filled cells lie up to a spacing outside of it and may enter the sphere by as much, those inside
// are kept off it by their depth. Without that the weak outer cells are crushed flat between the sphere and
// the full ones below, and fold. Grasped nodes move with the sphere.
#include "sim/tool_motion.h"

#include "shaders/shared_constants.h"

#include <algorithm>
#include <cmath>

namespace serosa::sim {

glm::dvec3 ToolMotion::apply(const glm::dvec3& x, const glm::dvec3& free, bool held, double depth) const {
    if (mode == SRS_TOOL_GRASP)
        return held ? x + (to - from) : free;
    if (mode != SRS_TOOL_PUSH)
        return free;
    const glm::dvec3 away = free - to;
    const glm::dvec3 start = x - from;
    const double distance = glm::length(away), apart = glm::length(start);
    const double reach = std::min(std::max(radius + depth, 0.0), apart + SRS_EJECTION);
    if (!(distance < reach)) // what is no number stays so: a tool must not hide it
        return free;
    const glm::dvec3 normal = apart > 1e-6 ? start / apart : glm::dvec3(0, 1, 0);
    const double along = glm::dot(away, normal), aside2 = std::max(distance * distance - along * along, 0.0);
    return free + normal * (std::sqrt(std::max(reach * reach - aside2, 0.0)) - along);
}

namespace {

RigidShape inLatticeUnits(RigidShape shape, double spacing) {
    shape.radius /= spacing;
    shape.length /= spacing;
    shape.bend /= spacing;
    shape.middle /= spacing;
    shape.halfSize /= spacing;
    shape.fieldScale = 1 / spacing;
    return shape;
}

} // namespace

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
        motion.shape = inLatticeUnits(tool.wholeShape(), setup.lattice->spacing);
        motion.radius = motion.shape.radius;
        motion.friction = tool.friction;
        motion.grip = tool.gripForce * setup.timeStep * setup.timeStep /
                      (setup.tissue.nodeMass(setup.lattice->spacing) * setup.lattice->spacing);
        const bool active = tool.activeAt(start + tick);
        if (tool.mode == ToolMode::push) {
            motion.mode = SRS_TOOL_PUSH;
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
                glm::length(state.positions[node] - tools[tool].from) < tools[tool].radius)
                holder = std::uint32_t(tool + 1);
        }
    }
}

} // namespace serosa::sim
