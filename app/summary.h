#pragma once
// What a run found, and how it is written as summary.json (keys: docs/cli.md). Everything that differs
// between two runs on one machine stands under `timing`.

#include "gpu/context.h"
#include "render/surface_binding.h"
#include "sim/lattice.h"
#include "sim/lattice_state.h"
#include "sim/mesh_repair.h"
#include "sim/pieces.h"
#include "sim/scene.h"
#include "sim/solver.h"
#include "sim/texture_layout.h"
#include "sim/thread_hold.h"
#include "sim/watchdog.h"

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace serosa::app {

struct EnergySample {
    double time = 0; // s
    sim::Energies energies;
    double largestDisplacement = 0; // m
};

/// What tools and bodies gave to the organs in one frame.
struct ForceSample {
    double time = 0;                  // s: end of the frame
    std::vector<sim::ToolLoad> means; // over the frame, one a collider: N and N m, where loads have N s and
                                      // N m s
};

/// Of one thread of the scene.
struct ThreadRecord {
    struct Sample {
        double time = 0, force = 0; // s; N, averaged
    };
    std::vector<Sample> samples;
    sim::ThreadState last;
};

/// Contact of two organs of the scene, or of one with itself.
struct PairRecord {
    struct Sample {
        double time = 0;     // s: end of the time since the sample before, over which these are means
        glm::dvec3 force{0}; // N, on the first from the second; none of contact with itself
        double pressed = 0;  // N: sum of the sizes of the normal forces on the nodes
    };
    std::size_t organs[2] = {0, 0};
    std::vector<Sample> samples;
};

struct RunTimes { // s of wall time
    double steps = 0, mapping = 0, draw = 0, files = 0, setup = 0, total = 0;
};

/// A level of detail that an organ came to.
struct LevelChange {
    int frame = 0, level = 1;
};

/// Of one organ; what is pointed at outlives the record.
struct OrganRecord {
    std::string solver; // "fragment", "reference", "pose"
    std::size_t vertices = 0, faces = 0;
    std::optional<sim::RepairReport> repair; // where it was asked for
    const sim::Lattice* lattice = nullptr;
    const sim::TextureLayout* layout = nullptr;
    std::size_t fixedNodes = 0;
    sim::StableStep step; // zero for a pose
    const render::SurfaceBinding* binding = nullptr;
    double largestDisplacement = 0; // m, over the samples
    std::size_t invertedCells = 0;  // most at one sample (sim/cell_volumes.h)
    std::string stateHash;
    std::size_t strokes = 0, springsCut = 0; // of the last sampled state
    sim::PieceCount pieces;
    std::vector<LevelChange> levels; // of detail, by frame; of an organ that has several
    std::optional<sim::Alarm> alarm; // of the watchdog, which froze it
};

/// Where a run began that did not begin at rest.
struct RunStart {
    std::string snapshot; // file name
    int frame = 0;
    std::string solver; // that made it
};

struct RunRecord {
    sim::Scene scene;
    std::string solver; // of the first organ that is simulated; "pose" where none is
    gpu::ContextInfo gl;
    std::vector<OrganRecord> organs; // in the scene's order
    int framesDone = 0, picturesWritten = 0, surfacesWritten = 0;
    int snapshotsWritten = 0, displacementsWritten = 0;
    std::optional<RunStart> from;
    std::string end = "complete";      // or "interrupted", "organ stopped"
    double largestDisplacement = 0;    // m, over the samples and organs
    std::vector<EnergySample> samples; // sums over the organs
    std::vector<ForceSample> forces;   // sums over the organs
    std::vector<ThreadRecord> threads; // in the scene's order
    std::vector<PairRecord> contacts;  // of organs that may touch
    std::vector<std::string> notes;    // what was said before the first step
    RunTimes times;

    /// Of all organs, joined by '-' where there are several.
    std::string stateHash() const;
};

nlohmann::ordered_json summaryJson(const RunRecord& record);

/// Largest distance of a node from rest, in metres, and the node. `finite` is false where a coordinate is not
/// finite; the node is then the first such one.
struct Displacement {
    double largest = 0;
    std::size_t node = 0;
    bool finite = true;
};
Displacement largestDisplacement(const sim::Lattice& lattice, const sim::LatticeState& state);

} // namespace serosa::app
