#pragma once
// Anisotropy along a fibre direction a, as far as 18 springs allow it.
//
// Fibres add C a_i a_j a_k a_l to the stiffness: under tension along a they carry C strain, and nothing
// across, so that C = E_fibre - E. Springs of direction n and constant k add (k L^2/h^3) n_i n_j n_k n_l
// each, of nine directions: three axes, six face diagonals. The nine constants, none below zero, are those
// whose sum comes nearest to the fibres' tensor (least squares over all of its components), times the one
// factor that gives E_fibre under tension along a.
//
// What that allows. Young's modulus along the fibres is as given, in every direction. Along an axis or a face
// diagonal all else is right, too. Elsewhere the fibres' tensor has components that no spring has (a_x^2 a_y
// a_z, which needs springs along space diagonals), and what is added is spread over the springs around a:
// some of it stiffens the directions across. Fibres four times as stiff as the tissue make it 1.2 times as
// stiff across at the median of random directions and 1.9 times at worst, where up to 1.05 would be right
// (tests/sim/materials_test.cpp).

#include <glm/glm.hpp>

#include <array>

namespace serosa::sim {

/// Constants of the springs along direction pair d/2 (order of kNeighbourOffsets), over the spacing, in the
/// unit of `young`, that fibres along `direction` (any length above 0) add to tissue of Young's modulus
/// `young` and Poisson's ratio `poisson`. \param fibreYoung along the fibres; at least `young`
std::array<double, 9> fibreSprings(const glm::dvec3& direction, double young, double poisson,
                                   double fibreYoung);

} // namespace serosa::sim
