#pragma once
// A given motion instead of a simulated one: MS05 figure 6, the lattice bent to a radius of a few spacings.

#include "base/result.h"
#include "sim/lattice.h"
#include "sim/lattice_state.h"

namespace serosa::app {

/// All nodes after a bend about the z axis with `curvature` (1/m): x is the arc length along the centre line,
/// which stays level at the lattice's middle; the ends go down. Cross-sections stay plane and unstretched.
/// Normals by MS05 eq. 3.
sim::LatticeState bentState(const sim::Lattice& lattice, double curvature);

/// Errors: the lattice reaches below the centre of the bend, where it would turn inside out.
Status checkBend(const sim::Lattice& lattice, double bendRadius);

/// MS05 eq. 3: packed normals from deformed positions (lattice units), as the fragment solver writes them.
std::vector<std::uint32_t> latticeNormals(const sim::Lattice& lattice,
                                          const std::vector<glm::dvec3>& positions);

} // namespace serosa::app
