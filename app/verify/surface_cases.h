#pragma once
// Parts of group `surface` of `serosa verify`.

#include "app/verify/verify.h"
#include "sim/lattice.h"
#include "sim/scene.h"
#include "sim/scene_keys.h"
#include "sim/triangle_mesh.h"

#include <string>

namespace serosa::app {

/// As the scene's key has it: "node-frames".
inline const std::string& mappingWord(sim::Mapping mapping) {
    return sim::findSceneKey("look", "mapping")->words[std::size_t(mapping)];
}

struct SurfaceCase {
    sim::TriangleMesh mesh; // m
    sim::Lattice lattice;
};

/// A phantom on a lattice of about `nodes` nodes, or of this spacing, m.
Result<SurfaceCase> surfaceCase(const std::string& phantom, std::size_t faces, std::size_t nodes,
                                double spacing = 0);

/// Ball number `number` with random bumps, stretched and turned at random, closed, on 400 to 3000 nodes.
Result<SurfaceCase> randomSurface(unsigned number);

/// Silhouettes, stretched edges, flipped faces, gaps: MS05 figures 1, 2, 5, 6.
Status verifySurfaceFigures(const VerifyOptions& options, CheckList& checks);
/// Exactness on random surfaces; normals in a smooth bend; tangent frames.
Status verifySurfaceExactness(const VerifyOptions& options, CheckList& checks);
/// Eq. 3 against true normals, and what the choice per vertex makes of it.
Status verifySurfaceNormals(const VerifyOptions& options, CheckList& checks);

} // namespace serosa::app
