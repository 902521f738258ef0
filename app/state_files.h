#pragma once
// What a run writes of its state at the times that the scene names: snapshots, and the displacement of each
// lattice as a vector image and as points (docs/snapshots.md).

#include "app/output_folder.h"
#include "app/scene_player.h"

#include <set>
#include <string>

namespace serosa::app {

class StateFiles {
public:
    /// All outlive this.
    StateFiles(const RunParts& parts, ScenePlayer& player, OutputFolder& folder);

    /// Frames at whose end something is written.
    void snapshotAt(int frame) { snapshotFrames_.insert(frame); }
    void displacementAt(int frame) { displacementFrames_.insert(frame); }
    bool due(int frame) const {
        return snapshotFrames_.contains(frame) || displacementFrames_.contains(frame);
    }
    /// What is due after player.frame() frames. Errors: of the files.
    Status write();

    int snapshots() const { return snapshots_; }         // written
    int displacements() const { return displacements_; } // images written, without masks

private:
    Status writeDisplacement(std::size_t organ);
    /// "displacement_NAME_000030.nrrd", without NAME where there is one organ.
    std::string fileName(std::size_t organ, const std::string& what, const std::string& extension) const;

    const RunParts& parts_;
    ScenePlayer& player_;
    OutputFolder& folder_;
    std::set<int> snapshotFrames_, displacementFrames_;
    std::set<std::size_t> masked_; // organs whose mask is written
    int snapshots_ = 0, displacements_ = 0;
};

} // namespace serosa::app
