#pragma once
// `serosa bench --pick`: which solver is fastest on this machine, written to the user's configuration.

#include "base/result.h"
#include "gpu/context.h"

#include <cstddef>
#include <iosfwd>

namespace serosa::app {

struct PickOptions {
    gpu::GlChoice gl = gpu::GlChoice::automatic;
    std::size_t nodes = 20000; // lattice nodes aimed at
    int rounds = 5;
    double seconds = 0.3; // a turn of a solver
};

/// Steps a heart of that many nodes with every solver in interleaved rounds, after checking that all of them
/// agree with the reference; prints the table and writes the fastest. Returns an exit code: 0, or 1 where one
/// does not agree (then nothing is written). Errors: no context, the file system's.
Result<int> pickFastestSolver(const PickOptions& options, std::ostream& out);

} // namespace serosa::app
