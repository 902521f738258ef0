#pragma once
// `serosa run`: from a scene or a model to pictures, deformed surfaces and a summary.

#include "app/other_surfaces.h"
#include "base/result.h"
#include "gpu/context.h"
#include "sim/scene.h"

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>

namespace serosa::app {

struct RunOptions {
    std::filesystem::path scene; // either a scene file,
    OtherSurfaces surfaces;      // of its organs,
    std::filesystem::path model; // or a model
    std::string lengthUnit;      // and its unit: "mm",
    sim::UpAxis upAxis = sim::UpAxis::y;
    bool repair = false;             // and whether to mend it
    std::string solver = "fragment"; // of solverNames() (app/solver_choice.h); empty: of `from`
    gpu::GlChoice gl = gpu::GlChoice::automatic;
    int layout = -1;                  // SRS_LAYOUT_..., -1: by how full the grid is
    std::optional<int> frames;        // each of these replaces what the scene says
    std::optional<int> width, height; // pixels
    std::optional<sim::Mapping> mapping;
    std::optional<sim::Show> show;
    std::optional<std::size_t> nodes; // of each organ
    std::optional<double> spacing;    // m
    std::filesystem::path out;        // empty: the scene's or model's name with "-out", in the current folder
    bool force = false;               // write into a folder that holds something
    std::filesystem::path from;       // a snapshot to go on from; empty: from rest
    bool anySolver = false;           // let `solver` be another than that of the snapshot
    bool hands = false;               // add the user's tools (app/hands.h), as far as there is room
};

/// Runs and writes into the output folder; says on `out` what it does. SIGINT ends it after the frame in
/// hand. Returns an exit code: 0, 1 (the watchdog stopped an organ), 130 (interrupted). Bad input
/// is an Error, and leaves nothing behind.
Result<int> runScene(const RunOptions& options, std::ostream& out);

} // namespace serosa::app
