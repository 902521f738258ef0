#pragma once
// What an input device says about a tool that a hand holds, at one moment. Whatever the device: a mouse, a
// recording, a script.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace serosa::devices {

struct ToolSample {
    double time = 0;             // s, of the simulation
    glm::dvec3 at{0};            // m, world: of the tool's reference point
    glm::dquat turn{1, 0, 0, 0}; // unit; w, x, y, z
    bool active = false;         // from here on: a push is there, a grasp is closed
};

} // namespace serosa::devices
