#pragma once
// A scene's state, frame by frame. A frame is always the same number of steps, so what comes after 300 of
// them is the same bytes however they were paced and drawn: `serosa view` plays what `serosa run` runs.

#include "app/group_guard.h"
#include "app/level_state.h"
#include "app/organ_guard.h"
#include "app/run_setup.h"
#include "app/summary.h"
#include "sim/cut_list.h"
#include "sim/lattice_state.h"
#include "sim/snapshot.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace serosa::app {

class ScenePlayer {
public:
    /// `parts` must be prepared, and outlive this.
    explicit ScenePlayer(RunParts& parts);

    /// One frame of the scene: for each organ its steps, or its next pose; the textures follow. Poses stay as
    /// they are after the scene's last frame. Every kFramesBetweenChecks frames the states are checked.
    void advance();
    /// Back to rest, frame 0.
    void reset();
    /// All of the state, after frame() frames (reads back, stalls).
    sim::Snapshot snapshot();
    /// Goes on from a snapshot that belongs to the scene (app/scene_snapshot.h).
    void restore(const sim::Snapshot& snapshot);

    int frame() const { return frame_; }
    double time() const { return frame_ / parts_.scene.frameRate; } // s
    /// Steps of all solvers a frame.
    int stepsPerFrame() const;
    /// Reads an organ's state back (stalls).
    sim::LatticeState state(std::size_t organ) const;
    /// The strokes that an organ met so far.
    const sim::CutList& cuts(std::size_t organ) const { return cuts_[organ]; }
    /// What they left, as LatticeState::connections; empty: nothing is cut.
    const std::vector<std::uint32_t>& connections(std::size_t organ) const {
        return shownConnections_[organ];
    }
    /// Of all organs, joined by '-': `state_hash` of a run's summary after as many frames.
    std::string stateHash() const;
    /// Lets the watchdog look at all organs now. One whose state is wrong goes back to its last good one and
    /// is frozen until the next reset; the others live on.
    void check();
    /// Why an organ is frozen, if it is.
    std::optional<sim::Alarm> alarm(std::size_t organ) const;
    /// "NAME: ..." a line for each organ that is frozen.
    std::vector<std::string> alarmLines() const;
    /// Of the scene's threads: forces are those of the last step (waits for the GPU).
    std::vector<sim::ThreadState> threads() const;
    /// What coupled organs gave each other: as GroupGuard::takePairLoads, in the order of RunParts::coupled.
    sim::PairLoads takePairLoads();
    /// What tools and bodies gave to an organ, frame by frame, as OrganGuard::takeLoads; empty for a pose.
    std::vector<FrameLoads> takeLoads(std::size_t organ, bool all = false);

    /// The levels of detail that an organ was on; empty where it has but one.
    const std::vector<LevelChange>& levelChanges(std::size_t organ) const { return changes_[organ]; }

private:
    /// The level that an organ is to be on at the end of this frame.
    int wantedLevel(std::size_t organ) const;
    /// Takes a frame's steps, and hands over to another level if one is wanted and nothing is against it: a
    /// cut organ stays on its level, and tools that hold tissue must let go first.
    void takeSteps(std::size_t organ);
    void changeLevel(std::size_t organ, int level, const std::vector<glm::dvec3>& before);
    /// A frame of the organs that step together, if there are any.
    void advanceCoupled();
    /// Another level's solver is the organ's.
    void newGuard(std::size_t organ);
    /// At rest, on the level that a run begins with.
    void startLevel(std::size_t organ);
    void lookAtLevels();
    LevelState levelState(std::size_t organ) const;
    /// On its level, whose solver's state is set by others.
    void restoreLevel(std::size_t organ, int level, const LevelState& state);
    void check(std::size_t organ);
    /// The renderer draws an organ's state, which was set back.
    void showState(std::size_t organ);

    /// The scene's cuts and tears of the frame that ends now.
    void cut(std::size_t organ);
    /// What the renderer's mask holds (SurfaceRenderer::saveCuts); empty: nothing is cut.
    void setCutMask(std::size_t organ, std::string_view bytes);
    /// Lets the renderer draw what cuts left, if they changed anything. Reads the bits back (stalls).
    /// \param inMotion the surface goes over to what is left; else it is drawn so at once
    void showCuts(std::size_t organ, bool inMotion = false);
    /// What a snapshot says of what still fades.
    void restoreBlend(std::size_t organ, const LevelState& state);

    RunParts& parts_;
    int frame_ = 0;
    std::vector<sim::CutList> cuts_;                           // one an organ
    std::vector<std::size_t> lastCut_;                         // of the scene, that each organ met
    std::vector<std::vector<std::uint32_t>> shownConnections_; // one an organ; empty: nothing is cut
    std::vector<std::optional<sim::LatticeState>> posed_;      // one an organ
    std::vector<std::optional<OrganGuard>> guards_; // one an organ; none for a pose, or of the group
    std::optional<GroupGuard> group_;               // of coupled organs
    std::vector<LevelChoice> levelChoices_;         // one an organ
    std::vector<std::vector<LevelChange>> changes_; // one an organ
};

} // namespace serosa::app
