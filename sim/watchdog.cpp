// See sim/watchdog.h.
#include "sim/watchdog.h"

#include "shaders/shared_constants.h"
#include "sim/tool_motion.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace serosa::sim {

namespace {

// Increments are half a step behind positions: the sum of both energies of one mode at the margin's end
// (omega dt = 1.4) swings between 0.4 and 1.5 of its mean, so a true sum may read up to 3.8 times an earlier
// one.
constexpr double kEnergyTolerance = 4;
// Of all springs: energy at this strain everywhere is what float32 positions may invent.
constexpr double kRoundingStrain = 1e-3;
constexpr double kViolentJump = 0.5; // spacings a step, of a node against a neighbour
constexpr double kLookStretch = 1.5; // nodes without a spring this many times its rest length need no look

double restLength(int direction) {
    return direction < 6 ? 1.0 : std::sqrt(2.0);
}

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Largest eigenvalue of the sum over a node's springs of w (n n^T + across (1 - n n^T)); at rest where
/// `positions` is null.
double stiffness(const Lattice& lattice, const TissueField& field, std::uint32_t connections,
                 std::size_t node, const std::vector<glm::dvec3>* positions) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
        const std::int64_t other = connections >> d & 1u ? lattice.neighbour(node, d) : -1;
        if (other < 0)
            continue;
        const glm::dvec3 along = positions ? (*positions)[node] - (*positions)[std::size_t(other)]
                                           : glm::dvec3(kNeighbourOffsets[std::size_t(d)]);
        const double length = std::max(glm::length(along), 1e-9),
                     across = std::max(0.0, 1 - restLength(d) / length);
        const Eigen::Vector3d n(along.x / length, along.y / length, along.z / length);
        sum += field.springWeight(node, d) *
               ((1 - across) * n * n.transpose() + across * Eigen::Matrix3d::Identity());
    }
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

/// J: impulse times velocity, and angular impulse times angular velocity. Both are constant between keys;
/// where they change in this time, the largest possible work.
double workOf(const Tool& tool, double from, double to, const ToolLoad& load) {
    double fastest = 0, fastestTurn = 0, last = from;
    glm::dvec3 velocity(0), turning(0);
    int pieces = 0;
    const auto piece = [&](double end) {
        if (end - last <= 1e-9 * (to - from))
            return;
        const RigidPose a = tool.poseAt(last), b = tool.poseAt(end);
        velocity = (b.at - a.at) / (end - last);
        glm::dquat turn = b.turn * glm::conjugate(a.turn);
        turn = turn.w < 0 ? -turn : turn;
        const glm::dvec3 axis(turn.x, turn.y, turn.z); // sin(angle/2) long
        const double sine = glm::length(axis);
        turning = sine > 0 ? axis * (2 * std::atan2(sine, turn.w) / sine / (end - last)) : glm::dvec3(0);
        fastest = std::max(fastest, glm::length(velocity));
        fastestTurn = std::max(fastestTurn, glm::length(turning));
        last = end;
        ++pieces;
    };
    for (const ToolKey& key : tool.keys)
        if (key.time > from && key.time < to)
            piece(key.time);
    piece(to);
    if (pieces > 1)
        return glm::length(load.impulse) * fastest + glm::length(load.angular) * fastestTurn;
    return glm::dot(load.impulse, velocity) + glm::dot(load.angular, turning);
}

} // namespace

const char* alarmName(AlarmKind kind) {
    switch (kind) {
    case AlarmKind::notFinite:
        return "not finite";
    case AlarmKind::energy:
        return "energy";
    case AlarmKind::step:
        return "step";
    }
    return "";
}

std::string Alarm::text() const {
    char where[160], why[320];
    std::snprintf(where, sizeof where, "node %zu at (%.4g, %.4g, %.4g) mm", node, 1e3 * position.x,
                  1e3 * position.y, 1e3 * position.z);
    if (kind == AlarmKind::notFinite)
        std::snprintf(
            why, sizeof why,
            " is not finite at %.6g s: look for a value beyond all measure (gravity, a tool's keys, "
            "a start), or raise frame_rate for smaller steps",
            time);
    else if (kind == AlarmKind::energy)
        std::snprintf(why, sizeof why,
                      " has most of an energy that runs away: %.4g J kinetic and elastic at %.6g s, where "
                      "tools, gravity and the start can have put in %.4g J: raise frame_rate for smaller "
                      "steps, raise damping_time, or move tools more slowly",
                      measured, time, allowed);
    else
        std::snprintf(
            why, sizeof why,
            " overruns the time step: its springs are stretched so far on all sides at %.6g s that "
            "only steps below %.4g ms are stable, and they are %.4g ms: move tools more slowly, let "
            "the tissue tear, or raise frame_rate for smaller steps",
            time, 1e3 * allowed, 1e3 * measured);
    return std::string(where) + why;
}

Watchdog::Watchdog(const SolverSetup& setup, const StableStep& step) : setup_(setup), step_(step) {
    SEROSA_CHECK(setup.lattice && setup.timeStep > 0, "a lattice and a time step");
    field_ = std::make_shared<const TissueField>(*setup.lattice, setup.tissue);
    const Lattice& lattice = *setup.lattice;
    double stretched = 0; // of all springs at a strain of 1, k h^2
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < SRS_NEIGHBOURS; d += 2)
            if (lattice.neighbour(node, d) >= 0)
                stretched += 0.5 * field_->springWeight(node, d) * (d < 6 ? 1 : 2);
    floor_ = stretched * kRoundingStrain * kRoundingStrain * setup.tissue.springConstant(lattice.spacing) *
             lattice.spacing * lattice.spacing;
}

void Watchdog::start(const LatticeState& state) {
    const Energies now = energies(setup_, state);
    budget_ = now.kinetic + now.elastic + now.gravitational + floor_;
    const std::vector<ToolMotion> tools = colliderMotions(setup_, state.step);
    embedded_.assign(tools.size(), false);
    for (std::size_t i = 0; i < tools.size(); ++i)
        for (std::size_t node = 0; node < state.positions.size() && !embedded_[i]; ++node) {
            const glm::dvec3& at = state.positions[node];
            embedded_[i] = tools[i].apply(at, at, false, setup_.lattice->restDepth(node)) != at;
        }
    energyShare_ = 0;
}

void Watchdog::addWork(double from, double to, const std::vector<ToolLoad>& loads) {
    const double ejection = SRS_EJECTION * setup_.lattice->spacing / setup_.timeStep; // m/s
    for (std::size_t i = 0; i < loads.size(); ++i) {
        const ToolLoad& load = loads[i];
        double work = i < setup_.tools.size() ? workOf(setup_.tools[i], from, to, load) : 0;
        if (i < embedded_.size() && embedded_[i]) // what it pushes out moves by itself
            work += glm::length(load.impulse) * ejection;
        // What a tool takes back is not deducted: tissue that slides around a tool is lifted a little more
        // than the contact's plane says, and where a deeply embedded tool has large forces all round, their
        // small sum says little. check() follows the energy down.
        if (std::isfinite(work))
            budget_ += std::max(0.0, work);
    }
}

double Watchdog::available(const LatticeState& state) const {
    return std::max(0.0, budget_ - energies(setup_, state).gravitational);
}

std::optional<Alarm> Watchdog::check(const LatticeState& state) {
    SEROSA_CHECK(state.positions.size() == setup_.lattice->nodeCount(), "a state of this lattice");
    if (const std::optional<Alarm> alarm = checkFinite(state))
        return alarm;
    return checkEnergy(state, largestJump(state) > kViolentJump);
}

std::optional<Alarm> Watchdog::checkFinite(const LatticeState& state) const {
    for (std::size_t node = 0; node < state.positions.size(); ++node)
        if (!finite(state.positions[node]) || !finite(state.increments[node]))
            return alarmAt(AlarmKind::notFinite, node, state);
    return {};
}

double Watchdog::largestJump(const LatticeState& state) const {
    const Lattice& lattice = *setup_.lattice;
    const std::vector<std::uint32_t>& connections =
        state.connections.empty() ? lattice.connections : state.connections;
    double largest2 = 0;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node)
        for (int d = 0; d < SRS_NEIGHBOURS; d += 2) {
            const std::int64_t other = connections[node] >> d & 1u ? lattice.neighbour(node, d) : -1;
            if (other < 0)
                continue;
            const glm::dvec3 jump = state.increments[node] - state.increments[std::size_t(other)];
            largest2 = std::max(largest2, glm::dot(jump, jump));
        }
    return std::sqrt(largest2);
}

std::optional<Alarm> Watchdog::checkStretch(const LatticeState& state) const {
    const Lattice& lattice = *setup_.lattice;
    const std::vector<std::uint32_t>& connections =
        state.connections.empty() ? lattice.connections : state.connections;
    std::size_t worst = 0;
    double most = 1; // stiffness over that at rest
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        // What does not follow forces cannot resonate with them.
        if (state.heldBy[node] != 0 || (!setup_.fixed.empty() && setup_.fixed[node]))
            continue;
        bool stretched = false;
        for (int d = 0; d < SRS_NEIGHBOURS && !stretched; ++d) {
            const std::int64_t other = connections[node] >> d & 1u ? lattice.neighbour(node, d) : -1;
            if (other < 0)
                continue;
            const glm::dvec3 along = state.positions[node] - state.positions[std::size_t(other)];
            stretched = glm::dot(along, along) > kLookStretch * kLookStretch * (d < 6 ? 1 : 2);
        }
        if (!stretched)
            continue;
        const double rest = stiffness(lattice, *field_, lattice.connections[node], node, nullptr),
                     share = stiffness(lattice, *field_, connections[node], node, &state.positions) / rest;
        if (share > most) {
            most = share;
            worst = node;
        }
    }
    const double rate2 = step_.stiffestRate2 + (most - 1) * step_.springRate2,
                 damped = step_.dampingRate + setup_.tissue.airDrag, dt = setup_.timeStep;
    if (most == 1 || dt * dt * rate2 + 2 * dt * damped < 4)
        return {};
    Alarm alarm = alarmAt(AlarmKind::step, worst, state);
    alarm.measured = dt;
    alarm.allowed = (std::sqrt(damped * damped + 4 * rate2) - damped) / rate2;
    return alarm;
}

std::optional<Alarm> Watchdog::checkEnergy(const LatticeState& state, bool violent) {
    const Energies now = energies(setup_, state);
    const double inside = now.kinetic + now.elastic,
                 available = std::max(0.0, budget_ - now.gravitational) + floor_;
    energyShare_ = inside / available;
    // A step that is too long for a moment does no harm: what it has given is the proof.
    if (violent && inside > available && setup_.method == StepMethod::explicitSteps)
        if (const std::optional<Alarm> alarm = checkStretch(state))
            return alarm;
    if (violent && inside > kEnergyTolerance * available) {
        Alarm alarm = alarmAt(AlarmKind::energy, mostEnergetic(state), state);
        alarm.measured = inside;
        alarm.allowed = available;
        return alarm;
    }
    budget_ = std::min(budget_, now.gravitational + kEnergyTolerance * inside + floor_);
    return {};
}

Alarm Watchdog::alarmAt(AlarmKind kind, std::size_t node, const LatticeState& state) const {
    return {kind,
            node,
            setup_.lattice->toWorld(state.positions[node]),
            state.step,
            double(state.step) * setup_.timeStep,
            0,
            0};
}

std::size_t Watchdog::mostEnergetic(const LatticeState& state) const {
    const Lattice& lattice = *setup_.lattice;
    const std::vector<std::uint32_t>& connections =
        state.connections.empty() ? lattice.connections : state.connections;
    const double kinetic =
        1 / (setup_.timeStep * setup_.timeStep * setup_.tissue.stiffnessOverMass(lattice.spacing));
    std::size_t most = 0;
    double largest = -1;
    for (std::size_t node = 0; node < lattice.nodeCount(); ++node) {
        const glm::dvec3& u = state.increments[node];
        double energy = field_->massShare(node) * kinetic * glm::dot(u, u); // twice, in k h^2
        for (int d = 0; d < SRS_NEIGHBOURS; ++d) {
            const std::int64_t other = connections[node] >> d & 1u ? lattice.neighbour(node, d) : -1;
            if (other < 0)
                continue;
            const double stretch =
                glm::length(state.positions[node] - state.positions[std::size_t(other)]) - restLength(d);
            energy += 0.5 * field_->springWeight(node, d) * stretch * stretch; // half of it is the other's
        }
        if (energy > largest) {
            largest = energy;
            most = node;
        }
    }
    return most;
}

} // namespace serosa::sim
