#pragma once
// What the tools of a scene do in one step, in lattice units: shared by the reference and the fragment
// solver's uniforms.

#include "sim/solver.h"

#include <glm/glm.hpp>

#include <limits>
#include <vector>

namespace serosa::sim {

struct ToolMotion {
    int mode = 0;              // SRS_TOOL_NONE (a grasp that is open), SRS_TOOL_PUSH, SRS_TOOL_GRASP
    bool closes = false;       // this step begins with taking hold of the nodes inside
    bool opens = false;        // this step begins with letting all go
    glm::dvec3 from{0}, to{0}; // reference point at the step's start and end, lattice units
    glm::dquat turnFrom{1, 0, 0, 0}, turnTo{1, 0, 0, 0};
    double radius = 0; // lattice units: the shape's
    RigidShape shape;  // lattice units
    double friction = 0;
    double grip = std::numeric_limits<double>::infinity(); // impulse that a grasp can give in a step, mass
                                                           // shares times lattice units

    /// Position after the step of a node that was at `x` and moves freely to `free`.
    /// \param depth of the node below the organ's surface at rest, lattice units: Lattice::restDepth
    glm::dvec3 apply(const glm::dvec3& x, const glm::dvec3& free, bool held, double depth) const;
};

/// Tools during step number `step` (from step * dt to (step + 1) * dt): one a tool of the setup.
std::vector<ToolMotion> toolMotions(const SolverSetup& setup, std::int64_t step);

/// Takes hold of nodes (not fixed, not held by another) and lets go, by `closes` and `opens`.
void updateHeldNodes(const SolverSetup& setup, const std::vector<ToolMotion>& tools, LatticeState& state);

} // namespace serosa::sim
