#pragma once
// `serosa map`: a detailed surface follows nodes that something else moves (another solver, an animation),
// given as a coarse mesh at rest and the same mesh in each frame (MS05 3.3: "as simple as a set of
// interconnected points").

#include "base/result.h"
#include "gpu/context.h"
#include "sim/scene.h"

#include <filesystem>
#include <iosfwd>
#include <string>

namespace serosa::app {

struct MapOptions {
    std::filesystem::path surface; // detailed, at rest; need not be closed
    std::filesystem::path nodes;   // coarse, at rest, in the same unit and place; need not be closed
    std::filesystem::path frames;  // folder: one mesh a frame, in the order of the file names
    std::string lengthUnit;        // of all of them
    sim::Mapping mapping = sim::Mapping::nodeFrames;
    std::filesystem::path out;
    bool force = false;
    bool pictures = false; // frame_000001.png and on, too, drawn from the nodes on the GPU
    int width = 960, height = 960;
    gpu::GlChoice gl = gpu::GlChoice::automatic;
};

/// Writes surface_000001.ply and on, in the files' unit, vertices and faces in the surface's order. Errors:
/// of the files; a frame of other vertices or faces than the nodes; a surface too far from the nodes; a
/// folder without meshes; a mapping that needs a lattice. Nothing is left behind then.
Result<int> mapNodes(const MapOptions& options, std::ostream& out);

} // namespace serosa::app
