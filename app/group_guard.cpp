// See app/group_guard.h.
#include "app/group_guard.h"

#include "base/check.h"
#include "shaders/shared_constants.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace serosa::app {

GroupGuard::GroupGuard(RunParts& parts, const std::vector<sim::CutList>& cuts)
    : parts_(parts), group_(*parts.coupled.group), frameTime_(1 / parts.scene.frameRate) {
    for (const std::size_t organ : parts.coupled.organs) {
        OrganParts& member = *parts.organs[organ];
        members_.push_back({organ, &member, &cuts[organ], {}, 0});
        watchdogs_.emplace_back(member.setup, member.step);
    }
}

std::vector<sim::LatticeState> GroupGuard::states() const {
    std::vector<sim::LatticeState> all;
    for (const Member& member : members_)
        all.push_back(member.parts->solver->state());
    return all;
}

void GroupGuard::restart(int frame, const std::vector<sim::ThreadState>& threads) {
    alarm_.reset();
    Good good;
    good.states = states(); // as the solvers round them
    group_.reconnect(0);    // all of them: cuts may have come or gone
    group_.restart(good.states.front().step, threads);
    good.threads = group_.threads();
    dropLoads();
    given_.clear();
    for (std::size_t m = 0; m < members_.size(); ++m) {
        members_[m].loads.clear();
        members_[m].accounted = frame;
        watchdogs_[m].start(good.states[m]);
    }
    seen_ = frame;
    const std::optional<Found> found = look(watchdogs_, good.states, 0);
    good.watchdogs = watchdogs_;
    good_.emplace(std::move(good));
    if (found) { // there is no better state than rest
        good_->states[found->member] = sim::restState(members_[found->member].parts->lattice);
        freeze(*found, *good_);
    }
}

void GroupGuard::account(std::size_t m, std::vector<sim::ToolLoad> loads) {
    Member& member = members_[m];
    watchdogs_[m].addWork(member.accounted * frameTime_, (member.accounted + 1) * frameTime_, loads);
    member.loads.push_back({++member.accounted, std::move(loads)});
}

void GroupGuard::accountAll() {
    for (std::size_t m = 0; m < members_.size(); ++m)
        for (std::vector<sim::ToolLoad>& loads : members_[m].parts->solver->flushFrames())
            account(m, std::move(loads));
}

void GroupGuard::dropLoads() {
    for (const Member& member : members_) {
        member.parts->solver->flushFrames();
        member.parts->solver->takeLoads();
    }
}

void GroupGuard::endFrame(int frame) {
    for (std::size_t m = 0; m < members_.size(); ++m) {
        members_[m].parts->solver->endFrame();
        if (auto loads = members_[m].parts->solver->frameLoads())
            account(m, std::move(*loads));
        SEROSA_CHECK(members_[m].accounted <= frame && frame <= members_[m].accounted + 2,
                     "one call a frame");
    }
}

double GroupGuard::takeWork(bool keepLoads) {
    const sim::PairLoads loads = group_.takeLoads();
    double spacing = 0, pressed = 0, work = 0;
    for (const Member& member : members_)
        spacing = std::max(spacing, member.parts->lattice.spacing);
    if (keepLoads && given_.empty())
        given_.assign(members_.size(), std::vector<sim::PairLoad>(members_.size()));
    for (std::size_t a = 0; a < loads.size(); ++a)
        for (std::size_t b = 0; b < loads.size(); ++b) {
            pressed += loads[a][b].pressed;
            if (!keepLoads)
                continue;
            given_[a][b].impulse += loads[a][b].impulse;
            given_[a][b].pressed += loads[a][b].pressed;
        }
    // Contact takes energy away, but for what it pushes out.
    work += pressed * SRS_EJECTION * spacing / members_.front().parts->setup.timeStep;
    for (const sim::ThreadState& thread : group_.takeThreads())
        work += thread.work;
    return std::isfinite(work) ? work : 0;
}

std::optional<GroupGuard::Found> GroupGuard::look(std::vector<sim::Watchdog>& watchdogs,
                                                  const std::vector<sim::LatticeState>& states, double work) {
    std::vector<double> available;
    double all = work;
    for (std::size_t m = 0; m < states.size(); ++m) {
        const double one = watchdogs[m].available(states[m]);
        available.push_back(std::isfinite(one) ? one : 0);
        all += available.back();
    }
    for (std::size_t m = 0; m < states.size(); ++m) {
        watchdogs[m].addEnergy(all - available[m]);
        if (const std::optional<sim::Alarm> alarm = watchdogs[m].check(states[m]))
            return Found{m, *alarm};
    }
    return {};
}

bool GroupGuard::check(int frame) {
    if (frozen() || seen_ == frame)
        return false;
    accountAll();
    const double work = takeWork(true);
    std::vector<sim::LatticeState> now = states();
    if (const std::optional<Found> found = look(watchdogs_, now, work)) {
        // Frame by frame first, then the steps of the first bad frame.
        const std::int64_t steps = members_.front().parts->step.stepsPerFrame;
        Found first = *found;
        if (const auto inFrame = retrace(*good_, frame * steps, int(steps))) {
            first = *inFrame;
            if (const auto atStep = retrace(*good_, first.alarm.step, 1))
                first = *atStep;
        }
        freeze(first, *good_);
        return true;
    }
    seen_ = frame;
    good_.emplace(Good{std::move(now), watchdogs_, group_.threads()});
    return false;
}

std::optional<sim::Alarm> GroupGuard::alarm(std::size_t organ) const {
    if (alarm_ && members_[alarm_->member].organ == organ)
        return alarm_->alarm;
    return {};
}

std::vector<FrameLoads> GroupGuard::takeLoads(std::size_t organ, bool all) {
    if (all && !frozen())
        accountAll();
    for (Member& member : members_)
        if (member.organ == organ)
            return std::exchange(member.loads, {});
    return {};
}

sim::PairLoads GroupGuard::takePairLoads() {
    return std::exchange(given_, {});
}

void GroupGuard::setStates(const Good& good) {
    for (std::size_t m = 0; m < members_.size(); ++m)
        members_[m].parts->solver->setState(good.states[m]);
    group_.reconnect(0);
    group_.restart(good.states.front().step, good.threads);
    dropLoads();
}

GroupGuard::Good GroupGuard::stepFrom(const Good& good, std::int64_t step, std::int64_t next) {
    group_.advance(int(next - step));
    Good after{{}, good.watchdogs, {}};
    bool cut = false;
    for (std::size_t m = 0; m < members_.size(); ++m) {
        sim::Solver& solver = *members_[m].parts->solver;
        const double timeStep = solver.setup().timeStep;
        after.watchdogs[m].addWork(double(step) * timeStep, double(next) * timeStep, solver.takeLoads());
        for (const sim::CutList::Entry& entry : members_[m].cuts->entries())
            if (entry.step > step && entry.step <= next) {
                const Status done = solver.cut(entry.stroke);
                SEROSA_CHECK(done.ok(), "a stroke that was made before");
                cut = true;
            }
    }
    if (cut)
        group_.reconnect(0);
    after.states = states();
    return after;
}

std::optional<GroupGuard::Found> GroupGuard::retrace(Good& good, std::int64_t last, int steps) {
    setStates(good);
    for (std::int64_t step = good.states.front().step; step < last;) {
        const std::int64_t next = std::min(last, step + steps);
        Good after = stepFrom(good, step, next);
        const double work = takeWork(false);
        after.threads = group_.threads();
        if (const std::optional<Found> found = look(after.watchdogs, after.states, work))
            return found;
        good = std::move(after);
        step = next;
    }
    return {};
}

void GroupGuard::freeze(const Found& found, const Good& good) {
    alarm_ = found;
    const sim::LatticeState& state = good.states[found.member];
    alarm_->alarm.position = members_[found.member].parts->lattice.toWorld(state.positions[found.alarm.node]);
    setStates(good);
    for (const Member& member : members_)
        member.parts->solver->forgetCuts(); // of steps that are taken back
}

} // namespace serosa::app
