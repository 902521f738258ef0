#pragma once
// Anisotropy along a fibre direction a, as far as 18 springs allow it.
//
// Fibres add C a_i a_j a_k a_l to the stiffness: under tension along a they carry C strain, and nothing
// across, so that C = E_fibre - E. Springs of direction n and constant k add (k L^2/h^3) n_i n_j n_k n_l
// each, of nine directions: three axes, six face diagonals. The nine constants, none below zero, are those
// whose sum comes nearest to the fibres' tensor (least squares over all of its components), scaled so that a
// stretch along a meets C exactly.
//
// What that allows. Along an axis or a face diagonal: exactly. Elsewhere the fibres' tensor has components
// that no spring has (a_x^2 a_y a_z, which needs springs along space diagonals) and is spread over the
// springs around a: stiffer along a than across, but with some of the stiffness across, and less contrast:
// along a space diagonal, the worst direction, tests/sim/fibre_test.cpp measures how much.

#include <glm/glm.hpp>

#include <array>

namespace serosa::sim {

/// Constants of the springs along direction pair d/2 (order of kNeighbourOffsets) in units of C h, for fibres
/// along `direction` (any length above 0).
std::array<double, 9> fibreSprings(const glm::dvec3& direction);

} // namespace serosa::sim
