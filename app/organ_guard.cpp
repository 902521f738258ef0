// See app/organ_guard.h.
#include "app/organ_guard.h"

#include "base/check.h"

#include <algorithm>
#include <utility>

namespace serosa::app {

OrganGuard::OrganGuard(OrganParts& organ, const sim::CutList& cuts, double frameTime)
    : organ_(organ), cuts_(cuts), frameTime_(frameTime), watchdog_(organ.setup, organ.step) {
    SEROSA_CHECK(organ.solver, "an organ that is simulated");
}

void OrganGuard::restart(int frame) {
    alarm_.reset();
    dropLoads();
    loads_.clear();
    sim::LatticeState state = organ_.solver->state(); // as the solver rounds it
    watchdog_.start(state);
    seen_ = accounted_ = frame;
    const std::optional<sim::Alarm> alarm = watchdog_.check(state);
    good_.emplace(Good{std::move(state), watchdog_});
    if (alarm) { // there is no better state than rest
        good_->state = sim::restState(organ_.lattice);
        freeze(*alarm, *good_);
    }
}

void OrganGuard::account(std::vector<sim::ToolLoad> loads) {
    watchdog_.addWork(accounted_ * frameTime_, (accounted_ + 1) * frameTime_, loads);
    loads_.push_back({++accounted_, std::move(loads)});
}

void OrganGuard::accountAll() {
    for (std::vector<sim::ToolLoad>& loads : organ_.solver->flushFrames())
        account(std::move(loads));
}

void OrganGuard::dropLoads() {
    organ_.solver->flushFrames();
    organ_.solver->takeLoads();
}

void OrganGuard::endFrame(int frame) {
    organ_.solver->endFrame();
    if (auto loads = organ_.solver->frameLoads())
        account(std::move(*loads));
    SEROSA_CHECK(accounted_ <= frame && frame <= accounted_ + 2, "one call a frame");
}

bool OrganGuard::check(int frame) {
    if (frozen() || seen_ == frame)
        return false;
    accountAll();
    sim::LatticeState state = organ_.solver->state();
    if (const std::optional<sim::Alarm> found = watchdog_.check(state)) {
        // Frame by frame first, then the steps of the first bad frame.
        const std::int64_t steps = organ_.step.stepsPerFrame, now = frame * steps;
        sim::Alarm alarm = *found;
        if (const auto inFrame = retrace(*good_, now, int(steps))) {
            alarm = *inFrame;
            if (const auto atStep = retrace(*good_, alarm.step, 1))
                alarm = *atStep;
        }
        freeze(alarm, *good_);
        return true;
    }
    seen_ = frame;
    good_.emplace(Good{std::move(state), watchdog_});
    return false;
}

std::vector<FrameLoads> OrganGuard::takeLoads(bool all) {
    if (all && !frozen())
        accountAll();
    return std::exchange(loads_, {});
}

std::optional<sim::Alarm> OrganGuard::retrace(Good& good, std::int64_t last, int steps) {
    sim::Solver& solver = *organ_.solver;
    solver.setState(good.state);
    dropLoads();
    for (std::int64_t step = good.state.step; step < last;) {
        const std::int64_t next = std::min(last, step + steps);
        solver.advance(int(next - step));
        Good after{{}, good.watchdog};
        after.watchdog.addWork(double(step) * organ_.setup.timeStep, double(next) * organ_.setup.timeStep,
                               solver.takeLoads());
        for (const sim::CutList::Entry& entry : cuts_.entries())
            if (entry.step > step && entry.step <= next) {
                const Status cut = solver.cut(entry.stroke);
                SEROSA_CHECK(cut.ok(), "a stroke that was made before");
            }
        after.state = solver.state();
        if (const std::optional<sim::Alarm> alarm = after.watchdog.check(after.state))
            return alarm;
        good = std::move(after);
        step = next;
    }
    return {};
}

void OrganGuard::freeze(const sim::Alarm& alarm, const Good& good) {
    alarm_ = alarm;
    alarm_->position = organ_.lattice.toWorld(good.state.positions[alarm.node]);
    organ_.solver->setState(good.state);
    organ_.solver->forgetCuts(); // of steps that are taken back
    dropLoads();
}

} // namespace serosa::app
