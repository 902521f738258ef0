#pragma once
// Keeps the watchdog (sim/watchdog.h) over organs that step together (app/organ_coupling.h), as
// app/organ_guard.h does over one. Energy goes from one organ to another, so each may hold what it was given
// and what all the others had; threads add the work by which they are drawn in. When one state is wrong, all
// organs of the group go back to the last good ones, retrace their steps to the one before, and are frozen.

#include "app/organ_guard.h"
#include "app/run_setup.h"
#include "sim/cut_list.h"
#include "sim/watchdog.h"

#include <optional>
#include <vector>

namespace serosa::app {

class GroupGuard {
public:
    /// Of parts.coupled, whose group is made; `cuts` are one an organ of the scene. Both outlive this.
    GroupGuard(RunParts& parts, const std::vector<sim::CutList>& cuts);

    /// The solvers' states were set from elsewhere, and are those after `frame` frames, with their threads
    /// (empty: as at the start).
    void restart(int frame, const std::vector<sim::ThreadState>& threads = {});
    /// Looks at the states. True: one is wrong, and all were set back and are frozen now.
    bool check(int frame);
    bool frozen() const { return alarm_.has_value(); }
    /// What is wrong with an organ of the scene.
    std::optional<sim::Alarm> alarm(std::size_t organ) const;

    /// The group took the steps of this frame, and cuts, if any, are made.
    void endFrame(int frame);
    /// What tools and bodies gave to an organ of the scene: as OrganGuard::takeLoads.
    std::vector<FrameLoads> takeLoads(std::size_t organ, bool all);
    /// What organs gave each other up to the last look, since the last call: [a][b] as sim::PairLoads.
    sim::PairLoads takePairLoads();

private:
    struct Member {
        std::size_t organ = 0; // of the scene
        OrganParts* parts = nullptr;
        const sim::CutList* cuts = nullptr;
        std::vector<FrameLoads> loads; // not taken yet
        int accounted = 0;             // the frame of the last of them
    };
    /// What was seen to be good, and what the watchdogs knew then: one a member.
    struct Good {
        std::vector<sim::LatticeState> states;
        std::vector<sim::Watchdog> watchdogs;
        std::vector<sim::ThreadState> threads;
    };
    struct Found {
        std::size_t member = 0;
        sim::Alarm alarm;
    };
    std::vector<sim::LatticeState> states() const;
    /// Upper bound of what the coupling gave since the last call, J.
    double takeWork(bool keepLoads);
    static std::optional<Found> look(std::vector<sim::Watchdog>& watchdogs,
                                     const std::vector<sim::LatticeState>& states, double work);
    void account(std::size_t member, std::vector<sim::ToolLoad> loads);
    void accountAll();
    void dropLoads();
    void setStates(const Good& good);
    /// As OrganGuard::retrace, of all.
    std::optional<Found> retrace(Good& good, std::int64_t last, int steps);
    Good stepFrom(const Good& good, std::int64_t step, std::int64_t next);
    void freeze(const Found& found, const Good& good);

    RunParts& parts_;
    sim::OrganGroup& group_;
    std::vector<Member> members_;
    std::vector<sim::Watchdog> watchdogs_; // one a member
    double frameTime_;                     // s
    std::optional<Good> good_;
    int seen_ = 0; // the frame of good_
    std::optional<Found> alarm_;
    sim::PairLoads given_; // not taken yet
};

} // namespace serosa::app
