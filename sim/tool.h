#pragma once
// Tools: a rigid shape that follows timed key poses, or a hand, and pushes (contact) or holds what it touched
// (grasp).

#include "sim/live_tool.h"
#include "sim/rigid_shape.h"

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace serosa::sim {

enum class ToolMode { push, grasp };

struct ToolKey {
    double time;                 // s
    glm::dvec3 at;               // m, world: of the shape's reference point
    glm::dquat turn{1, 0, 0, 0}; // of the shape
};

/// A push tool exists for the whole run and waits at its first and last pose. A grasp tool takes hold of the
/// nodes inside its shape at its first key and lets go at its last. A live tool of either mode follows the
/// samples of a hand: a push is there, a grasp holds, while they say so.
struct Tool {
    std::string name;
    ToolMode mode = ToolMode::push;
    double radius = 0.005;     // m: RigidShape::radius of `shape`
    std::vector<ToolKey> keys; // at least one, strictly increasing times; live: none
    RigidShape shape = {};     // its radius is the member above
    double friction = 0;       // push: Coulomb's coefficient against tissue
    double gripForce = std::numeric_limits<double>::infinity(); // grasp, N: pulled harder, it slips
    std::shared_ptr<const LiveTool> live = nullptr;             // not null: it is moved by a hand
    bool jaws = false; // drawn as two pads on either side (y) of the box that it holds
    int line = 0;      // of the scene file, for messages; 0: none

    /// Shape with the tool's radius.
    RigidShape wholeShape() const;
    /// Pose at a time: places linear, turns at an even rate between keys, constant before and after.
    RigidPose poseAt(double time) const;
    /// Its place.
    glm::dvec3 centreAt(double time) const { return poseAt(time).at; }
    /// Grasp: first key <= time < last key. Push: always. Live: as its samples say.
    bool activeAt(double time) const;
};

} // namespace serosa::sim
