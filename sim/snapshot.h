#pragma once
// The whole state of a scene in one file with a checksum: a run that goes on from it gives the same bytes as
// one that never stopped. docs/snapshots.md describes the file to the byte.
//
// A snapshot belongs to its scene (sim/setup_traits.h), to the solver that made it, and to one version of the
// program: on another of these it would go on with other bytes, and is refused. What only draws or writes may
// differ.

#include "base/result.h"
#include "sim/cut_list.h"
#include "sim/lattice_state.h"
#include "sim/setup_traits.h"
#include "sim/solver.h"
#include "sim/thread_hold.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace serosa::sim {

struct OrganSnapshot {
    std::string name;
    std::string solver;        // Solver::name(), or another way to move: "pose"
    std::vector<Trait> traits; // setupTraits(), and what else its motion depends on
    LatticeState state;
    std::vector<CutList::Entry> cuts; // strokes so far
    std::vector<CutLayer> layers;     // Solver::cutLayers()
    std::vector<glm::dvec3> impulses; // N s, one a tool: given to the organ, and not yet asked for
    std::uint64_t lastCut = 0;        // of the scene's cuts, that met the organ last
    std::uint32_t level = 1;          // of detail, that the state is of
    std::string levelState;           // what else its levels need, in the program's own bytes
    std::string cutMask;              // what strokes painted, in the drawing's own bytes
};

struct Snapshot {
    std::string program;    // version that wrote it: "0.1.0"
    std::string machine;    // what did the arithmetic, in words: another may round differently
    std::int64_t frame = 0; // frames of the scene so far
    double frameRate = 0;   // Hz
    std::vector<OrganSnapshot> organs;
    std::vector<ThreadState> threads; // of the scene's threads

    double time() const { return double(frame) / frameRate; } // s
};

/// State, cut layers and pending impulses of a solver (reads back, stalls). The impulses are taken
/// (Solver::takeToolImpulses): what the caller makes of them is its own.
void takeSnapshot(Solver& solver, OrganSnapshot& organ);

/// One line where the organ cannot go on with this solver and setup: another name, solver or trait, sizes or
/// bits that do not belong to the lattice.
/// \param solver empty: any will do, though the bytes will not be those of a run that never stopped.
Status checkSnapshot(const OrganSnapshot& organ, const std::string& name, const std::string& solver,
                     const std::vector<Trait>& traits, const Lattice& lattice);

/// Sets a solver to a snapshot that checkSnapshot has accepted; impulses that it had not been asked for are
/// dropped. Errors: of Solver::setCutLayers.
Status restoreSnapshot(const OrganSnapshot& organ, Solver& solver);

/// The bytes of a file.
std::string snapshotBytes(const Snapshot& snapshot);
/// Errors, each one line that begins with `name`: not a snapshot, cut off (where), bytes after the end,
/// damaged (the checksum), of another version of the format.
Result<Snapshot> parseSnapshot(std::string_view bytes, const std::string& name);

/// Errors: of the file (base/atomic_file.h).
Status writeSnapshot(const Snapshot& snapshot, const std::filesystem::path& file);
/// Errors: as parseSnapshot; the file cannot be read.
Result<Snapshot> readSnapshot(const std::filesystem::path& file);

} // namespace serosa::sim
