#pragma once
// The largest stable step of a lattice at rest, from the reference solver's own steps alone: a second way to
// what sim/stable_step.cpp estimates. The step's linear map has the eigenvalue -1, where it turns unstable,
// as soon as
//   largest eigenvalue of dt^2 M^-1 K + 2 dt M^-1 C  =  4 - 2 drag dt,  C = tau K_springs.
// One step from rest displaced by a small x gives K x, one with increments x gives C x.

#include "sim/solver.h"

namespace serosa::app {

struct TrueStep {
    double bound = 0;    // s
    double residual = 0; // of the eigenvalue, as a share: how far from converged; 0 where it was dense
};
/// Dense up to 100 nodes; beyond, Lanczos iteration with full orthogonalization until converged.
TrueStep trueStep(const sim::Lattice& lattice, const sim::Tissue& tissue);

} // namespace serosa::app
