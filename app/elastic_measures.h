#pragma once
// What an engineer measures on a test piece: Young's modulus, Poisson's ratio and bending stiffness of a
// lattice beam by a linear static solution in double (Eigen), and its first longitudinal period by stepping a
// solver.

#include "sim/lattice.h"
#include "sim/solver.h"

#include <glm/glm.hpp>

namespace serosa::app {

struct BeamMeasures {
    double youngShare = 0; // E / (2.5 k/h)
    double poisson = 0;
    double bendingShare = 0; // bending stiffness / (E I), I of the exact square section
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
BeamMeasures measureBeam(const Beam& beam);

/// Largest difference between the reference solver's one-step force and the linear stiffness used above, as a
/// share of the largest force, for a small random displacement: ties the static figures to the solver.
double linearForceMismatch(const sim::SolverSetup& setup);

/// Period of the first longitudinal mode of a free beam stepped by `solver`, s; the closed form is 2 L /
/// sqrt(E/rho).
double longitudinalPeriod(const Beam& beam, const sim::SolverSetup& setup, sim::Solver& solver);

/// Uniform random rotation from a seed, deterministic.
glm::dmat3 randomRotation(std::uint32_t seed);

} // namespace serosa::app
