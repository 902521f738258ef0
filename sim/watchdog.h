#pragma once
// Says when an organ's state can no longer be right, and at which node. A state is wrong where
//   - a coordinate is not finite;
//   - it holds more kinetic and elastic energy than can have come in, and a node moves by more than half a
//     spacing a step against a neighbour, which no wave that the step resolves does. Everything but tools is
//     conservative or takes energy away, and a tool cannot put in more than impulse times its velocity (of a
//     tool that turns, with the angular impulse times its angular velocity): a node that a tool moves goes
//     from the velocity v to the tool's V (a push: along the contact's normal) by the impulse J = m (V - v),
//     which gives it m (V^2 - v^2)/2 = J V - m |V - v|^2/2. So the energy that may be there, with gravity's
//     potential, is that of the start plus the sum of the positive J V; and never more than kEnergyTolerance
//     times what was there when last looked at, plus the work since, so that damping tightens the bound;
//   - its springs need a smaller step than it takes. A spring of length d resists along itself with k, across
//     with k (1 - L/d) where it is stretched. With S_i the sum of these 3x3 matrices over the springs of node
//     i, omega^2 <= max_i 2 |S_i| / m_i whatever the state is, exactly 12 k/m inside the rest lattice. Where
//     |S_i| has grown so far over its rest value that dt^2 omega^2 + 2 dt tau omega_s^2 < 4 (ARCHITECTURE.md,
//     stability) fails with omega scaled by it, the node overruns the step: double length on all sides, or
//     seven times along one axis. That is a bound from above, and a step that is too long for a moment does
//     no harm: an organ is stopped for it once it holds more energy than can have come in. Implicit steps
//     have no such bound: this is not looked at, the other two are.
// Checking changes nothing in the state.

#include "sim/lattice_state.h"
#include "sim/solver.h"
#include "sim/tissue_field.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace serosa::sim {

enum class AlarmKind { notFinite, energy, step };
/// "not finite", "energy", "step"
const char* alarmName(AlarmKind kind);

struct Alarm {
    AlarmKind kind = AlarmKind::notFinite;
    std::size_t node = 0;             // not finite: the first; else the one with the most of it
    glm::dvec3 position{0};           // m, world: of the node, where it was last finite if the caller knows
    std::int64_t step = 0;            // steps taken when it was seen
    double time = 0;                  // s, of that step
    double measured = 0, allowed = 0; // energy: J; step: s, the step that is taken and the largest stable one

    /// "node 12 at (1, 2, 3) mm ...: why, and what to do": one line.
    std::string text() const;
};

class Watchdog {
public:
    /// \param step as stableStep found it for the setup's lattice and tissue.
    Watchdog(const SolverSetup& setup, const StableStep& step);

    /// The state that a run begins with or goes on from; its tools are where they are at its step.
    void start(const LatticeState& state);
    /// What the colliders gave between two times in s. \param loads one a collider, as Solver::takeLoads
    void addWork(double from, double to, const std::vector<ToolLoad>& loads);
    /// J: kinetic and elastic energy that the state may have, by all that is known to have come in.
    double available(const LatticeState& state) const;
    /// What may have come in from elsewhere: from organs that are coupled with it (app/group_guard.h).
    void addEnergy(double joules) { budget_ += joules; }
    /// What is wrong with the state, if anything. A state without alarm becomes what the next is compared
    /// with.
    std::optional<Alarm> check(const LatticeState& state);
    /// Kinetic and elastic energy over what was allowed, at the last check.
    double energyShare() const { return energyShare_; }

private:
    std::optional<Alarm> checkFinite(const LatticeState& state) const;
    std::optional<Alarm> checkStretch(const LatticeState& state) const;
    std::optional<Alarm> checkEnergy(const LatticeState& state, bool violent);
    /// Of the increments of two joined nodes, the largest difference, spacings a step.
    double largestJump(const LatticeState& state) const;
    Alarm alarmAt(AlarmKind kind, std::size_t node, const LatticeState& state) const;
    std::size_t mostEnergetic(const LatticeState& state) const;

    SolverSetup setup_;
    StableStep step_;
    std::shared_ptr<const TissueField> field_; // not null; copies share it
    std::vector<bool> embedded_; // of the colliders: began inside the organ, and pushes it out (SRS_EJECTION)
    double budget_ = 0;          // J, gravity's potential included
    double floor_ = 0;           // J: below, rounding
    double energyShare_ = 0;     // at the last check
};

} // namespace serosa::sim
