#pragma once
// Digital phantoms generated from signed distance functions (negative inside): deterministic, closed,
// manifold, no self-contact. `serosa phantom NAME --faces N -o FILE`.

#include "base/result.h"
#include "models/solid.h"
#include "sim/lattice.h"
#include "sim/triangle_mesh.h"

#include <string>
#include <vector>

namespace serosa::models {

struct PhantomInfo {
    std::string name;        // "heart", "liver"
    std::string description; // one line
    std::size_t defaultFaces;
};
const std::vector<PhantomInfo>& phantoms();

/// Makes a phantom with at least `faces` faces (at most 5% more). Positions in millimetres, y up, about the
/// origin, with vertex colours. Errors: unknown name (with a suggestion), a face count that the shape cannot
/// have.
Result<sim::TriangleMesh> makePhantom(const std::string& name, std::size_t faces);
/// What cuts through a phantom show, in voxels of so many millimetres. Errors: unknown name, a phantom whose
/// inside is not known, and those of sampleSolid.
Result<ColourVolume> makePhantomVolume(const std::string& name, double voxel);
/// The same in metres.
Result<sim::TriangleMesh> phantomInMetres(const std::string& name, std::size_t faces);
/// The lattice of a phantom in metres, with about `nodes` nodes. Errors: also those of sim::buildLattice.
Result<sim::Lattice> phantomLattice(const std::string& name, std::size_t faces, std::size_t nodes);

} // namespace serosa::models
