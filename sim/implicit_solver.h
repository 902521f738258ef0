#pragma once
// Solvers that take one implicit step where explicit ones take many (StepMethod::implicit; the method is in
// sim/implicit_system.h and docs/methods/implicit.md). The factories of sim/solver.h and sim/cpu_solver.h
// make them where the setup asks for it.

#include "sim/implicit_stepper.h"
#include "sim/solver.h"

#include <memory>

namespace serosa::sim {

/// In double, one node after another, as far as the equations can be solved: the oracle.
std::unique_ptr<Solver> makeImplicitReferenceSolver(const SolverSetup& setup,
                                                    const ImplicitLimits& limits = exactLimits());

/// In float32 on all cores; the same bytes with any number of threads.
/// \param threads 0: as many as the machine has cores
std::unique_ptr<Solver> makeImplicitCpuSolver(const SolverSetup& setup, int threads = 0,
                                              const ImplicitLimits& limits = frameLimits());

/// What the last step of one of these solvers took; nullptr: another solver.
const ImplicitEffort* implicitEffort(const Solver& solver);

} // namespace serosa::sim
