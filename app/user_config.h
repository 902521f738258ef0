#pragma once
// The user's configuration: $XDG_CONFIG_HOME/serosa/config.toml, or ~/.config/serosa/config.toml. Only
// `serosa bench
// --pick` writes it, and only what is asked for by name reads it (--solver picked): nothing switches by
// itself.

#include "base/result.h"

#include <cstddef>
#include <filesystem>
#include <string>

namespace serosa::app {

/// What `serosa bench --pick` found: the table [picked].
struct PickedSolver {
    std::string solver;    // one of solverNames()
    std::size_t nodes = 0; // of the lattice that it was measured on
    std::string renderer;  // OpenGL renderer then
};

/// Errors: neither XDG_CONFIG_HOME nor HOME is an absolute path.
Result<std::filesystem::path> userConfigFile();

/// Errors: none was written yet (says what to do), the file is no TOML (file:line:column), an unknown solver.
Result<PickedSolver> readPickedSolver();

/// Replaces the table [picked], leaves the others (not their comments); makes the folder. The file appears
/// whole or not at all. Errors: of the file system; the file is there and is no TOML.
Status writePickedSolver(const PickedSolver& picked);

} // namespace serosa::app
