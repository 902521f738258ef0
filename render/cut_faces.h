#pragma once
// What of an organ's surface is drawn once cuts have opened it. The detailed surface: a face is left out
// where two of the nodes that carry it were neighbours and are no longer joined, are no longer joined nearby
// (render/cut_sides.h), or lie in different pieces, so that none is stretched across a gap. One-to-one: the
// outer faces of whole cells, and the faces that cuts freed (sim/pieces.h).

#include "render/surface_binding.h"
#include "sim/lattice.h"

#include <cstdint>
#include <vector>

namespace serosa::render {

/// One flag a face. \param faces mesh faces, over the vertices of the binding. \param connections 18 bits a
/// node.
std::vector<bool> facesLeft(const sim::Lattice& lattice, const std::vector<glm::uvec3>& faces,
                            const SurfaceBinding& binding, const std::vector<std::uint32_t>& connections);

} // namespace serosa::render
