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

/// What the tools gave to an organ in one frame.
struct FrameImpulses {
    int frame = 0;                    // the first is 1
    std::vector<glm::dvec3> impulses; // N s, one a tool
};

class OrganGuard {
public:
    /// An organ with a solver, and its strokes so far; both outlive this.
    OrganGuard(OrganParts& organ, const sim::CutList& cuts, double frameTime);

    /// The solver's state was set from elsewhere, and is that after `frame` frames.
    void restart(int frame);
    /// Frame number `frame` ends: its steps were taken, and its cuts made. What colliders gave in it comes
    /// two frames later (Solver::frameLoads), or with a look.
    void endFrame(int frame);
    /// Looks at the state. True: it is wrong, and the organ was set back and is frozen now. Nothing is done
    /// where the state was seen before.
    bool check(int frame);

    bool frozen() const { return alarm_.has_value(); }
    const std::optional<sim::Alarm>& alarm() const { return alarm_; }
    /// What came of the tools' impulses since the last call, frame by frame; the solver's loads are this
    /// guard's to take.
    std::vector<FrameImpulses> takeImpulses();
    /// The same with all of the frames that ended. Waits for the GPU.
    std::vector<FrameImpulses> flushImpulses();

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
    /// What colliders gave in the frame after the last one that is accounted for.
    void account(const std::vector<sim::ToolLoad>& loads);
    void accountAll();
    /// Forgets what the solver was given so far.
    void dropLoads();

    OrganParts& organ_;
    const sim::CutList& cuts_;
    double frameTime_; // s
    sim::Watchdog watchdog_;
    std::optional<Good> good_;
    int seen_ = 0, accounted_ = 0; // the frames of good_, and of the loads that came
    std::optional<sim::Alarm> alarm_;
    std::vector<FrameImpulses> impulses_; // not taken yet
};

} // namespace serosa::app
