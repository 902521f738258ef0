#pragma once
// Keeps the watchdog (sim/watchdog.h) over one simulated organ: looks at its state every kFramesBetweenChecks
// frames, so that drawing and stepping between them read nothing back, and keeps the last good one. When a
// look finds the state wrong, the organ goes back to the last good one and takes the same steps again,
// looking after each: that names the first node that went wrong, and leaves the organ one step before it.
// From then on it is frozen. States that pass are not changed.

#include "app/run_setup.h"
#include "sim/cut_list.h"
#include "sim/watchdog.h"

#include <optional>
#include <vector>

namespace serosa::app {

constexpr int kFramesBetweenChecks = 10;

class OrganGuard {
public:
    /// An organ with a solver, and its strokes so far; both outlive this.
    OrganGuard(OrganParts& organ, const sim::CutList& cuts, double frameTime);

    /// The solver's state was set from elsewhere, and is that after `frame` frames.
    void restart(int frame);
    /// Looks at the state. True: it is wrong, and the organ was set back and is frozen now. Nothing is done
    /// where the state was seen before.
    bool check(int frame);

    /// The state at the last look that found nothing wrong.
    const sim::LatticeState& lastGood() const { return good_->state; }
    /// Impulses that another guard of the same organ was not asked for.
    void carry(const std::vector<glm::dvec3>& impulses);

    bool frozen() const { return alarm_.has_value(); }
    const std::optional<sim::Alarm>& alarm() const { return alarm_; }
    /// Impulses of the tools until `frame` since the last call, as Solver::takeToolImpulses, which is this
    /// guard's to call. They are read back when they are asked for, or with a look.
    std::vector<glm::dvec3> takeToolImpulses(int frame);

private:
    /// What was seen to be good, and what the watchdog knew then.
    struct Good {
        sim::LatticeState state;
        sim::Watchdog watchdog;
    };
    /// Steps from `good` on until the first look that finds something. Steps `steps` at a time and makes the
    /// cuts of the list; `good` follows.
    std::optional<sim::Alarm> retrace(Good& good, std::int64_t last, int steps);
    void freeze(const sim::Alarm& alarm, const Good& good);
    /// Takes what tools gave until `frame` from the solver.
    void account(int frame);

    OrganParts& organ_;
    const sim::CutList& cuts_;
    double frameTime_; // s
    sim::Watchdog watchdog_;
    std::optional<Good> good_;
    int seen_ = 0, accounted_ = 0; // the frames of good_ and of impulses_
    std::optional<sim::Alarm> alarm_;
    std::vector<glm::dvec3> impulses_; // N s
};

} // namespace serosa::app
