#pragma once
// The `serosa` command line: options, help, exit codes (docs/cli.md).

#include <functional>

namespace CLI {
class App;
}

namespace serosa::app {

/// Runs one command. Errors are one line on stderr, "serosa: error: ...". Returns the exit code.
int runCommandLine(int argc, char** argv);

/// Hands over the whole tree of commands and options, and runs none of them: the manual page and the shell
/// completion are written from it (app/manual/).
void describeCommandLine(const std::function<void(const CLI::App&)>& describe);

} // namespace serosa::app
