#pragma once
// The solver for processors: all cores, the widest vectors that are there, float32. Same law as the
// reference; the same bytes whatever the number of threads.

#include "sim/solver.h"

namespace serosa::sim {

struct CpuOptions {
    int threads = 0; // 0: as many as the machine has cores
    /// Normals are for drawing only, so that only the last step of an advance() needs them; benchmarks write
    /// them in every step.
    bool normalsEveryStep = false;
};

/// Preconditions as makeReferenceSolver. Needs no GL context.
std::unique_ptr<Solver> makeCpuSolver(const SolverSetup& setup, const CpuOptions& options = {});

/// Highway's name of the instruction set that solvers made now use, such as "AVX2".
const char* cpuSolverTarget();

} // namespace serosa::sim
