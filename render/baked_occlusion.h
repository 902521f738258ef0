#pragma once
// How much of the surroundings each vertex sees at rest: it makes grooves and folds read. Baked once on the
// CPU.

#include "sim/triangle_mesh.h"

#include <vector>

namespace serosa::render {

/// Share of the soft light that arrives at each vertex, 0..1. Rays of a fixed, cosine-weighted pattern look
/// for the surface within 15% of its size; the farther it is, the less it takes. Fewer rays a vertex for
/// larger meshes (about 400,000 in all, four a vertex at least), then two rounds of averaging over
/// neighbours. The same result on any machine.
std::vector<float> bakeOcclusion(const sim::TriangleMesh& mesh);

} // namespace serosa::render
