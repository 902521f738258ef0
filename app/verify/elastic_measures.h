#pragma once
// What an engineer measures on a test piece: Young's modulus, Poisson's ratio, bending and torsional
// stiffness of a lattice beam, bulk modulus and sag by linear static solutions in double (Eigen), and its
// first longitudinal period by stepping a solver.

#include "sim/lattice.h"
#include "sim/solver.h"

#include <glm/glm.hpp>

namespace serosa::app {

struct BeamMeasures {
    double youngShare = 0; // E / that of the tissue
    double poisson = 0;
    double bendingShare = 0; // bending stiffness / (E I), I of the exact square section
    double torsionShare = 0; // torsional stiffness / (mu J), J = 0.1406 a^4 of the exact square section
};

/// A square beam, `thickness` x `thickness` x `length` cells, its axis turned by `turn` against the grid.
struct Beam {
    sim::Lattice lattice;
    glm::dmat3 turn{1};               // columns: the two lateral directions and the axis
    glm::dvec3 middle{0};             // lattice units
    double thickness = 0, length = 0; // cells
};
Beam makeBeam(double thickness, double length, const glm::dmat3& turn, double spacing);

/// Tension and pure bending by prescribed axial displacements of the end sections, lateral motion free;
/// strain, curvature, force and moment are taken over the middle third, the area is the material's.
/// \param torsion measure it, too.
BeamMeasures measureBeam(const Beam& beam, const sim::Tissue& tissue = {}, bool torsion = false);

/// Bulk modulus over the tissue's E / (3 (1 - 2 nu)): the piece under pressure on its true faces, volume
/// change over the middle third.
double bulkModulusShare(const Beam& piece, const sim::Tissue& tissue);

/// Shear modulus over the tissue's mu = E / (2 (1 + nu)): equal shear tractions on the four long faces, which
/// shear the section evenly; the angle is taken over the middle third.
double shearShare(const Beam& beam, const sim::Tissue& tissue);

/// Sag of the free end of a cantilever under its weight along the lateral axis y, over q L^4 / (8 E I) +
/// q L^2 / (2 kappa G A), kappa = 10 (1 + nu) / (12 + 11 nu) (Cowper 1966). The clamped section may not move
/// along the axis; it carries the weight evenly.
double cantileverSagShare(const Beam& beam, const sim::Tissue& tissue);

/// Largest difference between the reference solver's one-step force and the linear stiffness used above, as a
/// share of the largest force, for a small random displacement: ties the static figures to the solver.
double linearForceMismatch(const sim::SolverSetup& setup);

/// Period of the first longitudinal mode of a free beam stepped by `solver`, s; the closed form is 2 L /
/// sqrt(E/rho).
double longitudinalPeriod(const Beam& beam, const sim::SolverSetup& setup, sim::Solver& solver);

/// Uniform random rotation from a seed, deterministic.
glm::dmat3 randomRotation(std::uint32_t seed);

} // namespace serosa::app
