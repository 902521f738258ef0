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

/// What tools and bodies gave to an organ in one frame.
struct FrameLoads {
    int frame = 0;
    std::vector<sim::ToolLoad> loads; // one a collider
};

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
    /// Loads of earlier frames that another guard of the same organ was not asked for.
    void carry(std::vector<FrameLoads> loads) { loads_ = std::move(loads); }

    bool frozen() const { return alarm_.has_value(); }
    const std::optional<sim::Alarm>& alarm() const { return alarm_; }
    /// The solver took the steps of this frame, and cuts, if any, are made. Loads (Solver::endFrame) are this
    /// guard's to take.
    void endFrame(int frame);
    /// What tools and bodies gave in each frame, since the last call: frames up to the one two before the
    /// last that ended, in order, and after a look or with `all` up to that one. Only `all` waits for the
    /// GPU.
    std::vector<FrameLoads> takeLoads(bool all = false);

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
    /// Of the frame after the last one that was accounted for.
    void account(std::vector<sim::ToolLoad> loads);
    /// Those of all frames that ended.
    void accountAll();
    /// Drops what the solver has of loads.
    void dropLoads();

    OrganParts& organ_;
    const sim::CutList& cuts_;
    double frameTime_; // s
    sim::Watchdog watchdog_;
    std::optional<Good> good_;
    int seen_ = 0, accounted_ = 0; // the frames of good_ and of loads_
    std::optional<sim::Alarm> alarm_;
    std::vector<FrameLoads> loads_; // not taken yet
};

} // namespace serosa::app
