#pragma once
// Scripted tools: a sphere that follows timed key poses, and pushes (contact) or holds what it touched
// (grasp).

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace serosa::sim {

enum class ToolMode { push, grasp };

struct ToolKey {
    double time;   // s
    glm::dvec3 at; // centre, m, world
};

/// A push tool exists for the whole run and waits at its first and last pose. A grasp tool takes hold of the
/// nodes inside its sphere at its first key and lets go at its last.
struct Tool {
    std::string name;
    ToolMode mode = ToolMode::push;
    double radius = 0.005;     // m
    std::vector<ToolKey> keys; // at least one, strictly increasing times

    /// Centre at a time, m: linear between keys, constant before and after.
    glm::dvec3 centreAt(double time) const;
    /// Grasp: first key <= time < last key. Push: always.
    bool activeAt(double time) const;
};

} // namespace serosa::sim
