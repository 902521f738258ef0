#pragma once
// Solvers that take one implicit step where explicit ones take many (StepMethod::implicit; the method is in
// sim/implicit_system.h and docs/methods/implicit.md). The factories of sim/solver.h and sim/cpu_solver.h
// make them where the setup asks for it.

#include "sim/implicit_stepper.h"
#include "sim/solver.h"

#include <memory>
#include <optional>

namespace serosa::sim {

/// What solvers of implicit steps can say of their last one.
class HasImplicitEffort {
public:
    virtual ~HasImplicitEffort() = default;
    virtual ImplicitEffort effort() const = 0;
};

/// In double, one node after another, as far as the equations can be solved: the oracle.
std::unique_ptr<Solver> makeImplicitReferenceSolver(const SolverSetup& setup,
                                                    const ImplicitLimits& limits = exactLimits());

/// In float32 on all cores; the same bytes with any number of threads.
/// \param threads 0: as many as the machine has cores
std::unique_ptr<Solver> makeImplicitCpuSolver(const SolverSetup& setup, int threads = 0,
                                              const ImplicitLimits& limits = frameLimits());

/// In compute passes over state textures (sim/implicit_passes.h). Needs a current GL context.
/// \param name "fragment" or "compute": the passes are the same
/// \param layout as KernelOptions
/// Errors: as makeFragmentSolver.
Result<std::unique_ptr<Solver>> makeImplicitTextureSolver(const SolverSetup& setup, const char* name,
                                                          int layout = -1,
                                                          const ImplicitLimits& limits = frameLimits());

/// What the last step of one of these solvers took (the GPU's are read back); nothing: another solver.
std::optional<ImplicitEffort> implicitEffort(const Solver& solver);

} // namespace serosa::sim
