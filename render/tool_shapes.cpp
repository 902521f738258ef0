// See render/tool_shapes.h.
#include "render/tool_shapes.h"

#include <algorithm>
#include <cmath>

namespace serosa::render {

namespace {

constexpr double kClosing = 0.15;    // s: jaws close so long before they hold, and open so long after
constexpr double kOpenAngle = 0.4;   // rad: of each pad while they are open
constexpr double kPadShare = 0.3;    // thickness of a pad over the less of its width and length
constexpr double kPadEdge = 0.35;    // rounding of its edges over its thickness
constexpr double kShaftShare = 0.45; // radius of the shaft over the width of the pads
constexpr double kShaftLengths = 6;  // of the shaft, in lengths of the pads
constexpr double kHandShare = 0.4;   // of its radius that a hand that holds is drawn with
constexpr double kFloorRadii = 3;    // half a floor's patch, in radii of the organs' bounds

/// 0: closed, 1: open
double openShare(const sim::Tool& tool, double time) {
    if (tool.live)
        return tool.activeAt(time) ? 0 : 1;
    const double before = tool.keys.front().time - time, after = time - tool.keys.back().time;
    return std::clamp(std::max(before, after) / kClosing, 0.0, 1.0);
}

void addJaws(const sim::Tool& tool, double time, std::vector<DrawnShape>& shapes) {
    const sim::RigidPose pose = tool.poseAt(time);
    const glm::dvec3 half = tool.shape.halfSize + tool.radius; // of what they hold
    const double length = 2 * half.z, thickness = kPadShare * std::min(2 * half.x, length);
    sim::RigidShape pad;
    pad.kind = sim::ShapeKind::box;
    pad.radius = kPadEdge * thickness;
    pad.halfSize = glm::dvec3(half.x, 0.5 * thickness, half.z) - pad.radius;
    for (const double side : {1.0, -1.0}) {
        // About the pad's end at the shaft.
        const glm::dquat turn =
            pose.turn * glm::angleAxis(side * kOpenAngle * openShare(tool, time), glm::dvec3(1, 0, 0));
        pad.middle = {0, side * 0.5 * thickness, -half.z};
        shapes.push_back({pad, {pose.toWorld({0, side * half.y, length}), turn}, Finish::steel, 0});
    }
    sim::RigidShape knuckle; // joins the pads to the shaft
    knuckle.kind = sim::ShapeKind::box;
    const glm::dvec3 block(kShaftShare * 2 * half.x, half.y + thickness, 0.5 * thickness);
    knuckle.radius = kPadEdge * std::min({block.x, block.y, block.z});
    knuckle.middle = {0, 0, length + block.z};
    knuckle.halfSize = block - knuckle.radius;
    shapes.push_back({knuckle, pose, Finish::steel, 0});
    sim::RigidShape shaft;
    shaft.kind = sim::ShapeKind::capsule;
    shaft.radius = kShaftShare * 2 * half.x;
    shaft.length = kShaftLengths * length;
    shapes.push_back({shaft, {pose.toWorld({0, 0, length + 2 * block.z}), pose.turn}, Finish::steel, 0});
}

DrawnShape floorBelow(const sim::Body& body, const glm::dvec3& lowest, const glm::dvec3& highest) {
    const glm::dvec3 own = body.pose.toOwn(0.5 * (lowest + highest));
    DrawnShape floor{body.shape, body.pose, Finish::floor,
                     kFloorRadii * 0.5 * glm::distance(lowest, highest)};
    floor.pose.at = body.pose.toWorld({own.x, body.shape.radius, own.z});
    return floor;
}

} // namespace

std::vector<DrawnShape> drawnTool(const sim::Tool& tool, double time) {
    std::vector<DrawnShape> shapes;
    if (tool.live && !tool.activeAt(time))
        return shapes;
    if (tool.jaws)
        addJaws(tool, time, shapes);
    else
        shapes.push_back({tool.wholeShape(), tool.poseAt(time), Finish::steel, 0});
    if (tool.live && tool.mode == sim::ToolMode::grasp) // so that one sees what it holds
        shapes.front().shape.radius *= kHandShare;
    return shapes;
}

std::vector<DrawnShape> drawnShapes(const sim::Scene& scene, double time, const glm::dvec3& lowest,
                                    const glm::dvec3& highest) {
    std::vector<DrawnShape> shapes;
    for (const sim::Tool& tool : scene.tools)
        for (DrawnShape& shape : drawnTool(tool, time))
            shapes.push_back(std::move(shape));
    for (const sim::Body& body : scene.bodies)
        if (body.shape.kind == sim::ShapeKind::halfSpace)
            shapes.push_back(floorBelow(body, lowest, highest));
        else
            shapes.push_back({body.shape, body.pose, Finish::matte, 0});
    return shapes;
}

} // namespace serosa::render
