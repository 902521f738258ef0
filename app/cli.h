#pragma once
// The `serosa` command line: options, help, exit codes (docs/cli.md).

namespace serosa::app {

/// Runs one command. Errors are one line on stderr, "serosa: error: ...". Returns the exit code.
int runCommandLine(int argc, char** argv);

} // namespace serosa::app
