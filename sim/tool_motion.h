#pragma once
// What colliders (the tools of a scene, then its bodies) do in one step, in lattice units: shared by all
// solvers.

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
    RigidShape shape; // lattice units
    double friction = 0;
    double grip = std::numeric_limits<double>::infinity(); // impulse that a grasp can give in a step, mass
                                                           // shares times lattice units

    /// Into the shape's own frame, as it lies at the step's start and end.
    glm::dvec3 ownAtStart(const glm::dvec3& x) const { return glm::conjugate(turnFrom) * (x - from); }
    glm::dvec3 ownAtEnd(const glm::dvec3& x) const { return glm::conjugate(turnTo) * (x - to); }
    /// Where the tool's motion carries what is at `x` at the step's start.
    glm::dvec3 carried(const glm::dvec3& x) const {
        return turnFrom == turnTo ? x + (to - from) : to + turnTo * ownAtStart(x);
    }

    /// Position after the step of a node that was at `x` and moves freely to `free`. Pushed: by
    /// sim/contact_point.h. Held: by a grip without limit.
    /// \param depth of the node below the organ's surface at rest, lattice units: Lattice::restDepth
    glm::dvec3 apply(const glm::dvec3& x, const glm::dvec3& free, bool held, double depth) const;
};

/// Tools during step number `step` (from step * dt to (step + 1) * dt): one a tool of the setup.
std::vector<ToolMotion> toolMotions(const SolverSetup& setup, std::int64_t step);

/// The same, and after them the bodies, as pushing tools at rest. \param part of the step
struct StepPart {
    double from = 0, to = 1; // shares of the step
};
std::vector<ToolMotion> colliderMotions(const SolverSetup& setup, std::int64_t step, StepPart part = {});

/// Does a grasp that closes take hold of what is at `x` (lattice units)? What lies within its shape.
bool graspReaches(const ToolMotion& tool, const glm::dvec3& x);

/// Takes hold of nodes (not fixed, not held by another) and lets go, by `closes` and `opens`.
void updateHeldNodes(const SolverSetup& setup, const std::vector<ToolMotion>& tools, LatticeState& state);

} // namespace serosa::sim
