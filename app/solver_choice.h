#pragma once
// The solvers by the names that --solver takes.

#include "base/result.h"
#include "sim/solver.h"

#include <memory>
#include <string>
#include <vector>

namespace serosa::app {

/// Every solver, the default first: "fragment", "compute", "cpu", "reference".
const std::vector<std::string>& solverNames();

/// The solver of that name (one of solverNames()). \param layout SRS_LAYOUT_..., -1: by how full the grid is;
/// for those that step in textures. Needs a current GL context. Errors: as the solvers' own.
Result<std::unique_ptr<sim::Solver>> makeSolver(const std::string& name, const sim::SolverSetup& setup,
                                                int layout = -1);

} // namespace serosa::app
