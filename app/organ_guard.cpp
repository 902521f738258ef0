// See app/organ_guard.h.
#include "app/organ_guard.h"

#include "base/check.h"

#include <algorithm>

namespace serosa::app {

OrganGuard::OrganGuard(OrganParts& organ, const sim::CutList& cuts, double frameTime)
    : organ_(organ), cuts_(cuts), frameTime_(frameTime), watchdog_(organ.setup, organ.step) {
    SEROSA_CHECK(organ.solver, "an organ that is simulated");
}

void OrganGuard::restart(int frame) {
    alarm_.reset();
    organ_.solver->takeToolImpulses();
    impulses_.assign(organ_.setup.tools.size(), glm::dvec3(0));
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

void OrganGuard::account(int frame) {
    if (accounted_ == frame)
        return;
    const std::vector<glm::dvec3> impulses = organ_.solver->takeToolImpulses();
    watchdog_.addWork(accounted_ * frameTime_, frame * frameTime_, impulses);
    for (std::size_t i = 0; i < impulses.size(); ++i)
        impulses_[i] += impulses[i];
    accounted_ = frame;
}

bool OrganGuard::check(int frame) {
    if (frozen() || seen_ == frame)
        return false;
    account(frame);
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

std::vector<glm::dvec3> OrganGuard::takeToolImpulses(int frame) {
    if (!frozen())
        account(frame);
    std::vector<glm::dvec3> taken(impulses_.size(), glm::dvec3(0));
    std::swap(taken, impulses_);
    return taken;
}

void OrganGuard::carry(const std::vector<glm::dvec3>& impulses) {
    for (std::size_t i = 0; i < impulses.size(); ++i)
        impulses_[i] += impulses[i];
}

std::optional<sim::Alarm> OrganGuard::retrace(Good& good, std::int64_t last, int steps) {
    sim::Solver& solver = *organ_.solver;
    solver.setState(good.state);
    solver.takeToolImpulses();
    for (std::int64_t step = good.state.step; step < last;) {
        const std::int64_t next = std::min(last, step + steps);
        solver.advance(int(next - step));
        Good after{{}, good.watchdog};
        after.watchdog.addWork(double(step) * organ_.setup.timeStep, double(next) * organ_.setup.timeStep,
                               solver.takeToolImpulses());
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
    organ_.solver->takeToolImpulses();
}

} // namespace serosa::app
