#pragma once
// Snapshots (sim/snapshot.h) of a whole scene: what they belong to, and going on from one.

#include "app/run_setup.h"
#include "sim/setup_traits.h"
#include "sim/snapshot.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace serosa::app {

/// All that an organ's motion depends on: its setup, the scene's clock and cuts, tearing, coupling, its pose.
std::vector<sim::Trait> sceneTraits(const sim::Scene& scene, std::size_t organ, const OrganParts& parts);

/// What does the arithmetic here, in words; needs a context.
std::string machineOf(const RunParts& parts);

/// Reads options.from, if there is one; sets options.solver where that is left to the snapshot. Errors: of
/// the file; of another version of the program; a file inside the output folder, which --force empties.
Result<std::optional<sim::Snapshot>> readStart(RunOptions& options,
                                               const std::filesystem::path& outputFolder);

/// Whether prepared `parts` can go on from it; puts organs on its levels of detail. Errors begin with the
/// file's name: other organs, clock, scene or solver; no frame is left to run.
Status checkStart(const sim::Snapshot& snapshot, const RunOptions& options, RunParts& parts);

/// Says where a run goes on from, and what keeps it from the bytes of one that never stopped.
void describeStart(const sim::Snapshot& snapshot, const RunOptions& options, const RunParts& parts,
                   std::ostream& out);

/// `serosa inspect` of a snapshot. Errors: of the file.
Result<int> inspectSnapshot(const std::filesystem::path& file, std::ostream& out);

} // namespace serosa::app
